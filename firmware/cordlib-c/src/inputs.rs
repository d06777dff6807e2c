//! State of the robot's inputs. Pushed by the firmware, read by the main loop.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

use cord::board::{ChargerReadings, CliffLevels, HardwareFault, Received, TemperatureRange, WheelCounts};
use rvac_protocol::message::{Bumpers, Currents, Gyro, WheelDrops};
use rvac_units::{Angle, AngularSpeed, Current, Temperature, Tick, Voltage};

use crate::time::hw_get_time_ms;

/// Bytes that fit each queue of the connection.
pub(crate) const QUEUE_BYTES: usize = 1024;

/// The newest state of every input, and both byte queues.
#[derive(Debug)]
pub(crate) struct Inputs {
    pub(crate) received: VecDeque<Received>,
    pub(crate) to_send: VecDeque<u8>,
    pub(crate) bumpers: Bumpers,
    pub(crate) cliffs: CliffLevels,
    pub(crate) wheel_drops: WheelDrops,
    pub(crate) counts: WheelCounts,
    pub(crate) buttons: u8,
    pub(crate) docked: bool,
    pub(crate) gyro: Option<Gyro>,
    pub(crate) currents: Option<Currents>,
    battery: Option<BatteryReading>,
    /// Faults whose causes stand.
    pub(crate) hardware_faults: Vec<HardwareFault>,
}

/// What the firmware said of its battery, and when.
#[derive(Clone, Copy, Debug)]
struct BatteryReading {
    readings: ChargerReadings,
    taken: Tick,
}

impl Inputs {
    /// The newest readings of the battery, as old as they are.
    pub(crate) fn battery(&self, now: Tick) -> Option<ChargerReadings> {
        self.battery.map(|battery| ChargerReadings {
            age_ms: now.since(battery.taken),
            adapter: self.docked,
            ..battery.readings
        })
    }
}

static INPUTS: Mutex<Inputs> = Mutex::new(Inputs {
    received: VecDeque::new(),
    to_send: VecDeque::new(),
    bumpers: Bumpers {
        left: false,
        right: false,
    },
    cliffs: CliffLevels {
        left: 0,
        middle: 0,
        right: 0,
    },
    wheel_drops: WheelDrops {
        left: false,
        right: false,
    },
    counts: WheelCounts { left: 0, right: 0 },
    buttons: 0,
    docked: false,
    gyro: None,
    currents: None,
    battery: None,
    hardware_faults: Vec::new(),
});

/// The inputs. Never hold this while a callback runs.
pub(crate) fn inputs() -> MutexGuard<'static, Inputs> {
    INPUTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A bumper was pressed (1) or released (0) at this angle in radians, left positive: above 0 the left half, below 0 the
/// right half, 0 both. NaN counts as both.
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_bumper(angle: f64, pressed: i32) {
    let mut inputs = inputs();
    if angle >= 0.0 || angle.is_nan() {
        inputs.bumpers.left = pressed != 0;
    }
    if angle <= 0.0 || angle.is_nan() {
        inputs.bumpers.right = pressed != 0;
    }
}

/// Light that a cliff receiver sees, 0 (dark) to 1 (saturated), with the emitters as they are: sensor 0 left, 1 middle,
/// 2 right. NaN counts as dark, which is no floor.
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_cliff(sensor: i32, level: f64) {
    let level = (level.clamp(0.0, 1.0) * 1023.0) as u16;
    let mut inputs = inputs();
    match sensor {
        0 => inputs.cliffs.left = level,
        1 => inputs.cliffs.middle = level,
        2 => inputs.cliffs.right = level,
        _ => {}
    }
}

/// A wheel hangs (1) or is on the floor (0): wheel 0 left, 1 right.
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_wheel_drop(wheel: i32, hanging: i32) {
    let mut inputs = inputs();
    match wheel {
        0 => inputs.wheel_drops.left = hanging != 0,
        1 => inputs.wheel_drops.right = hanging != 0,
        _ => {}
    }
}

/// Totals of the wheel encoders, forward positive, wrapping.
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_encoders(left: i32, right: i32) {
    inputs().counts = WheelCounts { left, right };
}

/// A button, 0 to 7, is down (1) or up (0).
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_button(button: i32, down: i32) {
    let Some(bit) = u32::try_from(button)
        .ok()
        .and_then(|number| 1_u8.checked_shl(number))
    else {
        return;
    };
    let mut inputs = inputs();
    if down != 0 {
        inputs.buttons |= bit;
    } else {
        inputs.buttons &= !bit;
    }
}

/// The dock's contacts are closed (1) or open (0).
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_dock(closed: i32) {
    inputs().docked = closed != 0;
}

/// Heading since reset in radians, counter-clockwise positive, and rate in rad/s. A NaN in either means that the gyro
/// has no reading now.
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_gyro(heading: f64, rate: f64) {
    let known = heading.is_finite() && rate.is_finite();
    inputs().gyro = known.then(|| Gyro {
        // Headings wrap through the whole range of the integer.
        heading: Angle((heading * 1e6) as i64 as i32),
        rate: AngularSpeed::from_rad_per_s(rate),
    });
}

/// Motor currents in amperes. A NaN in any means that there are no readings.
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_currents(wheel_left: f64, wheel_right: f64, brush_main: f64) {
    let known = [wheel_left, wheel_right, brush_main]
        .iter()
        .all(|current| !current.is_nan());
    inputs().currents = known.then(|| Currents {
        wheel_left: Current::from_a(wheel_left),
        wheel_right: Current::from_a(wheel_right),
        brush_main: Current::from_a(brush_main),
    });
}

/// Battery: volts, amperes into the pack, degrees Celsius. A NaN in any means that there are no readings. Call it at least once
/// a second: a reading older than 2 s is none, and S17 then forbids motion.
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_battery(voltage: f64, current: f64, temperature: f64) {
    let known = [voltage, current, temperature]
        .iter()
        .all(|value| !value.is_nan());
    let taken = Tick(hw_get_time_ms());
    let readings = ChargerReadings {
        pack_mv: Voltage::from_v(voltage).0,
        input_mv: Voltage::from_v(voltage).0,
        current_ma: Current::from_a(current).0,
        temperature: Ok(TemperatureRange::exact(Temperature::from_celsius(temperature))),
        age_ms: 0,
        adapter: false,
    };
    inputs().battery = known.then_some(BatteryReading { readings, taken });
}

/// The clock fails, or two clocks disagree.
pub const CORD_FAULT_CLOCK: i32 = 0;
/// Flash, memory or stack failed a check.
pub const CORD_FAULT_MEMORY: i32 = 1;
/// Any other self-check failed.
pub const CORD_FAULT_INTERNAL: i32 = 2;

/// The cause of a hardware fault (CORD_FAULT_...) is present (1) or gone (0). While it is present everything is off, its
/// inhibit is latched, and cord_clear refuses it. Another number counts as CORD_FAULT_INTERNAL.
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_hardware_fault(fault: i32, present: i32) {
    let fault = match fault {
        CORD_FAULT_CLOCK => HardwareFault::Clock,
        CORD_FAULT_MEMORY => HardwareFault::Memory,
        _ => HardwareFault::Internal,
    };
    let standing = &mut inputs().hardware_faults;
    standing.retain(|other| *other != fault);
    if present != 0 {
        standing.push(fault);
    }
}

#[cfg(test)]
mod tests {
    use super::{cord_event_battery, cord_event_dock, inputs};
    use rvac_units::Tick;

    #[test]
    fn a_reading_of_the_battery_grows_old_and_the_dock_does_not() {
        // Without a clock the reading was taken at 0.
        cord_event_battery(15.2, -0.4, 25.0);
        cord_event_dock(1);
        for age_ms in [0, 1_500, 60_000] {
            let readings = inputs().battery(Tick(age_ms)).expect("a reading");
            assert_eq!((readings.age_ms, readings.pack_mv), (age_ms, 15_200));
            assert!(readings.adapter);
        }
        cord_event_battery(15.2, f64::NAN, 25.0);
        assert_eq!(inputs().battery(Tick(0)), None);
    }
}
