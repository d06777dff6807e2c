//! Contact switches.

use rvac_protocol::message::{Bumpers, WheelDrops};

/// Switches behind the bumper.
pub trait BumperSwitches {
    /// Number of zones, 0..=2.
    const ZONES: u8;

    /// Which zones are pressed. A bumper with one zone reports both sides.
    fn pressed(&mut self) -> Bumpers;
}

/// Switches that open when a wheel hangs.
pub trait WheelDropSwitches {
    /// Number of switches, 0..=2.
    const SWITCHES: u8;

    /// Which wheels hang. A machine with one switch for both reports both.
    fn hanging(&mut self) -> WheelDrops;
}

/// Switch behind the dust box.
pub trait DustBox {
    /// Whether the box is in; `None` when the machine has no such switch.
    fn inserted(&mut self) -> Option<bool>;
}
