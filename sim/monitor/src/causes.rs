//! Causes that forbid motion, and how long they have lasted.

use super::limits::{CLIFF_RIM_MM_PER_S, HARD_DRIVE, WHEEL_DROP_MS};
use crate::charging::{ChargeTimes, Charging};
use crate::encoders::EncoderWatch;
use crate::hardware::{HardwareTimes, HardwareTruth};
use crate::loads::{LoadTimes, WheelLoad};
use crate::pack::PackTimes;

/// Inputs of the firmware's pins in this millisecond, and ground truth that no pin shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pins {
    /// A bumper switch is closed.
    pub bumper: bool,
    /// A cliff receiver sees no floor although its emitter is lit.
    pub cliff: bool,
    /// A wheel hangs.
    pub wheel_drop: bool,
    /// The dock's contacts carry voltage.
    pub docked: bool,
    /// A button is down.
    pub button: bool,
    /// Encoder totals of left and right wheel.
    pub counts: [i32; 2],
    /// Speeds of the rims of left and right wheel in mm/s, forward positive (ground truth).
    pub rims_mm_per_s: [i32; 2],
    /// Speed of the body's centre in mm/s, forward positive (ground truth).
    pub speed_mm_per_s: i32,
    /// The body fell down the stairs (ground truth).
    pub fallen: bool,
    /// Charger and pack (ground truth).
    pub charging: Charging,
    /// The switches and receivers one by one; `None` = the simulator does not tell them apart, and no report is judged by them.
    pub sides: Option<Sides>,
    /// What sensors of the pack and of the motors show, with their faults and without those of the converter.
    pub sensed: Sensed,
    /// The motors of left and right wheel (ground truth); `None` = the simulator does not know.
    pub loads: Option<[WheelLoad; 2]>,
    /// The machine (ground truth).
    pub hardware: HardwareTruth,
}

/// Switches and receivers, from the left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sides {
    /// Pressed halves of the bumper.
    pub bumpers: [bool; 2],
    /// Receivers that see no floor.
    pub cliffs: [bool; 3],
    /// Wheels that hang.
    pub wheel_drops: [bool; 2],
    /// Buttons that are down, bit by number.
    pub buttons: u8,
}

/// Readings that a report may tell; `None` = this one cannot be compared now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sensed {
    /// Of the pack, mV.
    pub pack_mv: Option<i32>,
    /// Of the pack, tenths of a degree.
    pub temperature_dc: Option<i32>,
    /// Of left and right wheel, mA.
    pub currents_ma: Option<[i32; 2]>,
    /// Closeness at each proximity sensor, 0 = nothing, 255 = touching.
    pub proximity: Option<[u8; 8]>,
}

/// Drives of the motors, in millionths of full drive, forward positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drives {
    /// Left and right wheel.
    pub wheels: [i32; 2],
    /// Main brush, side brushes, suction.
    pub cleaners: [i32; 3],
}

impl Drives {
    /// Whether nothing is driven.
    #[must_use]
    pub fn is_off(&self) -> bool {
        !self.wheels_on() && !self.cleaners_on()
    }

    pub(crate) fn wheels_on(&self) -> bool {
        self.wheels != [0; 2]
    }

    pub(crate) fn cleaners_on(&self) -> bool {
        self.cleaners != [0; 3]
    }

    /// Whether the two wheels together push the body forward.
    pub(crate) fn forward(&self) -> bool {
        self.wheels[0] + self.wheels[1] > 0
    }

    /// Whether any wheel pushes forward.
    pub(crate) fn any_forward(&self) -> bool {
        self.wheels.into_iter().any(|wheel| wheel > 0)
    }

    pub(crate) fn any_backward(&self) -> bool {
        self.wheels.into_iter().any(|wheel| wheel < 0)
    }

    fn backward(&self) -> bool {
        self.wheels[0] + self.wheels[1] < 0
    }
}

/// Milliseconds for which each cause has lasted without a gap; 0 = absent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CauseTimes {
    pub(crate) bumper_ms: u32,
    /// Pressed while the robot is armed, off the dock, which may press it permanently.
    pub(crate) bumper_stuck_ms: u32,
    /// Pressed while the wheels push backward.
    pub(crate) bumper_backing_ms: u32,
    pub(crate) cliff_ms: u32,
    /// A wheel is driven backward beside an edge while its rim turns too fast.
    pub(crate) cliff_haste_ms: [u32; 2],
    /// Distance of the body backward with an edge in sight, less that forward, in micrometres.
    pub(crate) cliff_reversed_um: u32,
    pub(crate) wheel_drop_ms: u32,
    /// Since a wheel drop that lasted long enough to count.
    pub(crate) grounded_ms: u32,
    /// Any motor is driven.
    pub(crate) motors_run: bool,
    pub(crate) docked_ms: u32,
    pub(crate) undocked_ms: u32,
    pub(crate) button_ms: u32,
    /// Each wheel: driven hard while its encoder stands still.
    pub(crate) stalled_ms: [u32; 2],
    pub(crate) encoders: EncoderWatch,
    pub(crate) fallen: bool,
    pub(crate) charge: ChargeTimes,
    pub(crate) pack: PackTimes,
    pub(crate) hardware: HardwareTimes,
    pub(crate) loads: LoadTimes,
    /// Cleaners were off in the millisecond before.
    pub(crate) cleaners_start: bool,
    cleaners_were_on: bool,
    floor_ms: u32,
    counts: [i32; 2],
}

/// Floor that shows for less time does not end an edge.
const FLOOR_SURE_MS: u32 = 50;
/// Contacts that bounce open keep a robot docked for this long (S19), so S7's ten seconds off the dock begin after it.
const DOCK_CLEAR_MS: u32 = 300;
/// Long enough ago for every rule.
const LONG_AGO_MS: u32 = 1_000_000;

impl Default for CauseTimes {
    fn default() -> Self {
        Self {
            bumper_ms: 0,
            bumper_stuck_ms: 0,
            bumper_backing_ms: 0,
            cliff_ms: 0,
            cliff_haste_ms: [0; 2],
            cliff_reversed_um: 0,
            floor_ms: 0,
            wheel_drop_ms: 0,
            grounded_ms: LONG_AGO_MS,
            motors_run: false,
            docked_ms: 0,
            undocked_ms: 0,
            button_ms: 0,
            stalled_ms: [0; 2],
            encoders: EncoderWatch::default(),
            fallen: false,
            charge: ChargeTimes::default(),
            pack: PackTimes::default(),
            hardware: HardwareTimes::default(),
            loads: LoadTimes::default(),
            cleaners_start: false,
            cleaners_were_on: false,
            counts: [0; 2],
        }
    }
}

impl CauseTimes {
    /// A firmware that has just started cannot know how long a cause had lasted before.
    pub(crate) fn reset(&mut self) {
        self.bumper_stuck_ms = 0;
        self.bumper_backing_ms = 0;
        self.stalled_ms = [0; 2];
        self.cliff_reversed_um = 0;
        self.encoders = EncoderWatch::default();
        self.pack = PackTimes::default();
        self.hardware.reset();
        self.loads = LoadTimes::default();
    }

    /// Nobody may move the robot: it may stand against a wall for as long as it likes (S7).
    pub(crate) fn rest(&mut self) {
        self.bumper_stuck_ms = 0;
    }

    pub(crate) fn update(&mut self, pins: &Pins, drives: &Drives) {
        stand(&mut self.bumper_ms, pins.bumper);
        let is_away = self.undocked_ms >= DOCK_CLEAR_MS;
        stand(&mut self.bumper_stuck_ms, pins.bumper && is_away && !pins.docked);
        stand(&mut self.bumper_backing_ms, pins.bumper && drives.backward());
        stand(&mut self.cliff_ms, pins.cliff);
        self.update_reverse(pins, drives);
        stand(&mut self.wheel_drop_ms, pins.wheel_drop);
        self.grounded_ms = if self.wheel_drop_ms > WHEEL_DROP_MS {
            0
        } else {
            self.grounded_ms.saturating_add(1)
        };
        self.motors_run = !drives.is_off();
        stand(&mut self.docked_ms, pins.docked);
        stand(&mut self.undocked_ms, !pins.docked);
        stand(&mut self.button_ms, pins.button);
        let still = [pins.counts[0] == self.counts[0], pins.counts[1] == self.counts[1]];
        for ((stalled, drive), still) in self.stalled_ms.iter_mut().zip(drives.wheels).zip(still) {
            stand(stalled, still && drive.abs() > HARD_DRIVE);
        }
        self.counts = pins.counts;
        self.encoders.update(pins, drives);
        self.pack.update(&pins.charging, drives);
        self.hardware.update(pins.hardware, drives, pins.charging.driven);
        self.fallen = pins.fallen;
        self.charge.update(&pins.charging, self.motors_run, 1);
        self.cleaners_start = drives.cleaners_on() && !self.cleaners_were_on;
        self.cleaners_were_on = drives.cleaners_on();
    }
}

impl CauseTimes {
    /// The reverse from an edge.
    fn update_reverse(&mut self, pins: &Pins, drives: &Drives) {
        stand(&mut self.floor_ms, !pins.cliff);
        if self.floor_ms >= FLOOR_SURE_MS {
            self.cliff_reversed_um = 0;
        } else {
            // A millimetre per second is a micrometre in this millisecond.
            let backward_um = pins.speed_mm_per_s.saturating_neg();
            self.cliff_reversed_um = self.cliff_reversed_um.saturating_add_signed(backward_um);
        }
        let wheels = drives.wheels.into_iter().zip(pins.rims_mm_per_s);
        for (haste_ms, (drive, rim)) in self.cliff_haste_ms.iter_mut().zip(wheels) {
            stand(haste_ms, pins.cliff && drive < 0 && rim < -CLIFF_RIM_MM_PER_S);
        }
    }
}

pub(crate) fn stand(standing_ms: &mut u32, now: bool) {
    *standing_ms = if now { standing_ms.saturating_add(1) } else { 0 };
}
