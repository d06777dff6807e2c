//! Checks motors and charger against what is broken in the machine itself (S20, S21).

use super::causes::{Drives, stand};

/// What is really wrong with the microcontroller.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HardwareTruth {
    /// The crystal stands still.
    pub clock_fails: bool,
    /// A bit of the program is not what was written.
    pub image_damaged: bool,
    /// A register behind the pulses of the motors is not what the program wrote.
    pub pulses_damaged: bool,
}

/// Milliseconds for which a motor or the charger was on although the machine is broken.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HardwareTimes {
    pub(crate) clock_ms: u32,
    pub(crate) pulses_ms: u32,
    /// Since the damage, whatever was on, and over resets, which mend nothing.
    pub(crate) image_ms: u32,
    pub(crate) is_on: bool,
}

impl HardwareTimes {
    /// A reset loads every register anew, and starts the crystal again.
    pub(crate) const fn reset(&mut self) {
        self.clock_ms = 0;
        self.pulses_ms = 0;
    }

    pub(crate) fn update(&mut self, truth: HardwareTruth, drives: &Drives, charges: bool) {
        self.is_on = !drives.is_off() || charges;
        stand(&mut self.clock_ms, truth.clock_fails && self.is_on);
        stand(&mut self.pulses_ms, truth.pulses_damaged && self.is_on);
        stand(&mut self.image_ms, truth.image_damaged);
    }
}
