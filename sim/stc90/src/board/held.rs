//! Lines of the board that something holds, whatever the home says: a fault at a known cycle.

use super::motors::Motor;
use super::wiring::{DigitalLine, Wiring};

/// A line into the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeldLine {
    /// Left half of the bumper, on = pressed.
    BumperLeft,
    /// Right half of the bumper, on = pressed.
    BumperRight,
    /// A floor sensor, from the left, 0..=3; on = floor.
    Floor(usize),
    /// All wheels, on = one hangs.
    WheelDrop,
    /// On = the battery is good.
    BatteryOk,
    /// On = this motor draws too much.
    OverCurrent(Motor),
    /// The lamp that bumper, floor and wall sensors see by; off = it does not light, whatever the chip does.
    Lamp,
}

/// A line that is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Held {
    pub(super) signal: HeldLine,
    pub(super) is_on: bool,
    /// From this cycle on.
    pub(super) from: u64,
}

impl HeldLine {
    /// The line, if the chip sees it without the lamp's light.
    pub(super) fn plain_line(self, wiring: &Wiring) -> Option<DigitalLine> {
        match self {
            Self::WheelDrop => Some(wiring.wheel_drop),
            Self::BatteryOk => Some(wiring.battery_ok),
            Self::OverCurrent(motor) => wiring.over_currents.get(motor as usize).copied(),
            Self::BumperLeft | Self::BumperRight | Self::Floor(_) | Self::Lamp => None,
        }
    }

    /// The line, if the chip sees it by the lamp's light.
    pub(super) fn lit_line(self, wiring: &Wiring) -> Option<DigitalLine> {
        let [left, right] = wiring.bumpers;
        match self {
            Self::BumperLeft => Some(left),
            Self::BumperRight => Some(right),
            Self::Floor(number) => wiring.floors.get(number).copied(),
            Self::WheelDrop | Self::BatteryOk | Self::OverCurrent(_) | Self::Lamp => None,
        }
    }
}
