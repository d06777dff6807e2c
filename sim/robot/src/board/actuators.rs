//! Motors, sound and watchdog.

use cordlib::board::{Beeper, CleaningMotor, Watchdog, WheelDrive, WheelMotors};
use rvac_units::{Frequency, Ratio, Throttle};

/// Bridges of both wheels. They brake by pin default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheelBridges {
    pub(crate) left: WheelDrive,
    pub(crate) right: WheelDrive,
}

impl Default for WheelBridges {
    fn default() -> Self {
        Self {
            left: WheelDrive::Brake,
            right: WheelDrive::Brake,
        }
    }
}

impl WheelMotors for WheelBridges {
    fn drive(&mut self, left: WheelDrive, right: WheelDrive) {
        *self = Self { left, right };
    }
}

/// A cleaning motor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cleaner {
    pub(crate) duty: Throttle,
}

impl CleaningMotor for Cleaner {
    const PRESENT: bool = true;

    fn set(&mut self, duty: Throttle) {
        self.duty = duty;
    }
}

/// The tone generator: it stores the present tone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sounder {
    pub(crate) pitch: Option<Frequency>,
}

impl Beeper for Sounder {
    const PRESENT: bool = true;

    fn sound(&mut self, pitch: Frequency, _: Ratio) {
        self.pitch = Some(pitch);
    }

    fn silence(&mut self) {
        self.pitch = None;
    }
}

/// The watchdog: it counts milliseconds since it was fed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SimulatedWatchdog {
    pub(crate) unfed_ms: u32,
}

/// Time after which an unfed watchdog resets the chip: the middle of the 128 to 256 ms that the chips offer.
pub(crate) const WATCHDOG_MS: u32 = 200;

impl Watchdog for SimulatedWatchdog {
    fn feed(&mut self) {
        self.unfed_ms = 0;
    }
}
