//! Sensor faults.

use super::Sensors;
use crate::Pcg;

/// A sensor that can be made to lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SensorId {
    /// Left half of the bumper.
    BumperLeft,
    /// Right half of the bumper.
    BumperRight,
    /// A cliff sensor by number.
    Cliff(u8),
    /// Left wheel drop switch.
    WheelDropLeft,
    /// Right wheel drop switch.
    WheelDropRight,
    /// A proximity sensor by number.
    Proximity(u8),
    /// Left encoder.
    EncoderLeft,
    /// Right encoder.
    EncoderRight,
    /// Rate and heading of the gyro.
    Gyro,
    /// A dock receiver by number.
    DockReceiver(u8),
    /// The dock's contacts.
    DockContacts,
    /// Battery voltage.
    BatteryVoltage,
    /// Battery temperature.
    BatteryTemperature,
    /// Current of the left wheel motor.
    WheelLeftCurrent,
    /// Current of the right wheel motor.
    WheelRightCurrent,
    /// A button by number.
    Button(u8),
}

/// How a sensor lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SensorFault {
    /// It shows this count: switches are closed when it is not 0; levels 0..=255; millivolts, milliamperes, tenths of a
    /// degree. A stuck encoder or gyro ignores the number and keeps its last total.
    StuckAt(i32),
    /// Its reading is wrong by a normal random amount of this deviation in its own counts each millisecond; a switch is
    /// inverted with this probability.
    Noisy(f64),
    /// A switch shows the opposite, an encoder or gyro counts backward; levels are mirrored in their range.
    Inverted,
}

/// An encoder total that diverged while its sensor was faulty.
#[derive(Clone, Copy, Debug, Default)]
struct DriftingCounter {
    true_total: i32,
    shown: i32,
}

impl DriftingCounter {
    /// Gives what is shown now that the true total has moved on.
    fn follow(&mut self, true_total: i32, fault: Option<SensorFault>, random: &mut Pcg) -> i32 {
        let change = true_total.wrapping_sub(self.true_total);
        self.true_total = true_total;
        let seen = match fault {
            None => change,
            Some(SensorFault::StuckAt(_)) => 0,
            Some(SensorFault::Inverted) => change.wrapping_neg(),
            Some(SensorFault::Noisy(deviation)) => change.wrapping_add((deviation * random.normal()) as i32),
        };
        self.shown = self.shown.wrapping_add(seen);
        self.shown
    }
}

/// All sensors that lie, and what they show.
#[derive(Clone, Debug)]
pub(crate) struct Faults {
    active: Vec<(SensorId, SensorFault)>,
    random: Pcg,
    /// Some sensor was faulty before, so totals may differ from the truth permanently.
    engaged: bool,
    left: DriftingCounter,
    right: DriftingCounter,
    heading: DriftingCounter,
    shown: Sensors,
}

impl Faults {
    pub(crate) fn new(random: Pcg) -> Self {
        Self {
            active: Vec::new(),
            random,
            engaged: false,
            left: DriftingCounter::default(),
            right: DriftingCounter::default(),
            heading: DriftingCounter::default(),
            shown: Sensors::default(),
        }
    }

    /// Starts or ends a fault.
    pub(crate) fn set(&mut self, sensor: SensorId, fault: Option<SensorFault>, truth: &Sensors) {
        if !self.engaged {
            self.engaged = true;
            let counter = |total: i32| DriftingCounter {
                true_total: total,
                shown: total,
            };
            self.left = counter(truth.count_left);
            self.right = counter(truth.count_right);
            self.heading = counter(truth.gyro.unwrap_or_default().heading.0);
        }
        self.active.retain(|(active, _)| *active != sensor);
        if let Some(fault) = fault {
            self.active.push((sensor, fault));
        }
        self.apply(truth);
    }

    /// The reading that the firmware gets instead of `truth`, or `None` when no sensor was ever faulty.
    pub(crate) fn shown(&self) -> Option<&Sensors> {
        self.engaged.then_some(&self.shown)
    }

    fn of(&self, sensor: SensorId) -> Option<SensorFault> {
        self.active
            .iter()
            .find(|(active, _)| *active == sensor)
            .map(|(_, fault)| *fault)
    }

    /// Derives what is shown from the truth; after every step.
    pub(crate) fn apply(&mut self, truth: &Sensors) {
        if !self.engaged {
            return;
        }
        let mut shown = *truth;
        let (left, right) = (self.of(SensorId::EncoderLeft), self.of(SensorId::EncoderRight));
        shown.count_left = self.left.follow(truth.count_left, left, &mut self.random);
        shown.count_right = self.right.follow(truth.count_right, right, &mut self.random);
        if let Some(gyro) = &mut shown.gyro {
            let fault = self.of(SensorId::Gyro);
            gyro.heading.0 = self.heading.follow(gyro.heading.0, fault, &mut self.random);
            match fault {
                Some(SensorFault::StuckAt(_)) => gyro.rate.0 = 0,
                Some(SensorFault::Inverted) => gyro.rate.0 = gyro.rate.0.wrapping_neg(),
                Some(SensorFault::Noisy(_)) | None => {}
            }
        }
        for (sensor, fault) in &self.active {
            distort(&mut shown, *sensor, *fault, &mut self.random);
        }
        self.shown = shown;
    }
}

fn distort(shown: &mut Sensors, sensor: SensorId, fault: SensorFault, random: &mut Pcg) {
    let (mut levels_of_cliffs, mut levels) = (shown.cliff_levels, shown.proximity);
    match sensor {
        SensorId::BumperLeft => switch(&mut shown.bumper_left, fault, random),
        SensorId::BumperRight => switch(&mut shown.bumper_right, fault, random),
        SensorId::WheelDropLeft => switch(&mut shown.wheel_drop_left, fault, random),
        SensorId::WheelDropRight => switch(&mut shown.wheel_drop_right, fault, random),
        SensorId::DockContacts => switch(&mut shown.dock_contacts, fault, random),
        SensorId::Cliff(number) => {
            level(levels_of_cliffs.get_mut(usize::from(number)), fault, random);
            // Noise is drawn once for both, so that it does not depend on which reading is used.
            if !matches!(fault, SensorFault::Noisy(_)) {
                level(shown.cliff_dark.get_mut(usize::from(number)), fault, random);
            }
        }
        SensorId::Proximity(number) => level(levels.get_mut(usize::from(number)), fault, random),
        SensorId::DockReceiver(number) => {
            level(shown.dock_receivers.get_mut(usize::from(number)), fault, random);
        }
        SensorId::Button(number) => {
            let mask = 1u8.checked_shl(number.into()).unwrap_or(0);
            let mut down = shown.buttons & mask != 0;
            switch(&mut down, fault, random);
            shown.buttons = if down {
                shown.buttons | mask
            } else {
                shown.buttons & !mask
            };
        }
        SensorId::BatteryVoltage => amount(&mut shown.battery_voltage.0, fault, random),
        SensorId::WheelLeftCurrent => amount(&mut shown.wheel_left_current.0, fault, random),
        SensorId::WheelRightCurrent => amount(&mut shown.wheel_right_current.0, fault, random),
        SensorId::BatteryTemperature => {
            let mut tenths = i32::from(shown.battery_temperature.0);
            amount(&mut tenths, fault, random);
            shown.battery_temperature.0 = tenths.clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        }
        SensorId::EncoderLeft | SensorId::EncoderRight | SensorId::Gyro => {}
    }
    (shown.cliff_levels, shown.proximity) = (levels_of_cliffs, levels);
}

fn switch(closed: &mut bool, fault: SensorFault, random: &mut Pcg) {
    *closed = match fault {
        SensorFault::StuckAt(count) => count != 0,
        SensorFault::Inverted => !*closed,
        SensorFault::Noisy(probability) => *closed != (random.unit() < probability),
    };
}

fn level(shown: Option<&mut u8>, fault: SensorFault, random: &mut Pcg) {
    if let Some(level) = shown {
        *level = match fault {
            SensorFault::StuckAt(count) => count.clamp(0, 255) as u8,
            SensorFault::Inverted => 255 - *level,
            SensorFault::Noisy(deviation) => (f64::from(*level) + deviation * random.normal()) as u8,
        };
    }
}

fn amount(shown: &mut i32, fault: SensorFault, random: &mut Pcg) {
    *shown = match fault {
        SensorFault::StuckAt(count) => count,
        SensorFault::Inverted => shown.wrapping_neg(),
        SensorFault::Noisy(deviation) => shown.wrapping_add((deviation * random.normal()) as i32),
    };
}
