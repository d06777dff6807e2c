//! Currents, the battery and the charger.

use rvac_protocol::message::Currents;
use rvac_units::{Ratio, Temperature};

/// Measurement of motor currents.
pub trait CurrentSense {
    /// Whether currents are measured.
    const PRESENT: bool;
    /// Whether that of the main brush is measured, too. Where it is not, it reads 0 and means nothing.
    const BRUSH_MAIN: bool = Self::PRESENT;

    /// The newest readings, or `None` when there are none.
    fn currents(&mut self) -> Option<Currents>;
}

/// One set of readings of the pack and its supply. Raw conversions, not averaged: the charger needs the dither.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChargerReadings {
    /// At the pack's terminals, in mV.
    pub pack_mv: i32,
    /// At the charger's side of the shunt, in mV: the supply's voltage while current flows, else the pack's.
    pub input_mv: i32,
    /// Through the shunt into the pack, in mA; the board's calibrated offset is subtracted.
    pub current_ma: i32,
    /// Of the pack.
    pub temperature: Result<TemperatureRange, ThermistorFault>,
    /// How long ago the converter took these, in ms.
    pub age_ms: u32,
    /// The supply is on the contacts now (not as old as the rest).
    pub adapter: bool,
}

/// What a reading says of the pack's temperature: a thermistor whose curve nobody has measured leaves room for a range. The
/// rules against frost use the coldest, those against heat the warmest that it can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TemperatureRange {
    /// The pack is at least this warm.
    pub coldest: Temperature,
    /// The pack is at most this warm.
    pub warmest: Temperature,
}

impl TemperatureRange {
    /// Of a sensor that is known well enough.
    #[must_use]
    pub const fn exact(temperature: Temperature) -> Self {
        Self {
            coldest: temperature,
            warmest: temperature,
        }
    }
}

/// Faults of the temperature measurement. A board reports the first two, from the raw count; cordlib detects the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThermistorFault {
    /// Not connected.
    Open,
    /// The line is shorted.
    Shorted,
    /// Outside of what a pack can have.
    Range,
    /// Changed faster than a pack can.
    Jump,
    /// Does not change though the pack is charged.
    Frozen,
}

/// Drive of the charger's switch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChargeDrive {
    /// No current.
    #[default]
    Off,
    /// Conducts for this share of the board's envelope. Never 0, and never above 95 %, so that the board always has quiet
    /// time for its converter.
    Duty(Ratio),
}

/// Request to the dock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DockRequest {
    /// Nothing: no code is sent.
    #[default]
    Silent,
    /// Full current: the board sends its code while this holds.
    Current,
}

/// Measurement of the battery and the switch that charges it. Regulation, limits and all decisions belong to this crate
/// (`charge`); the board only measures and switches.
pub trait Charger {
    /// Whether the battery is measured.
    const PRESENT: bool;
    /// Whether this firmware controls the charger. Where it does not, a current into the pack is the other controller's, and no
    /// fault of charging is looked for.
    const CHARGES: bool;

    /// The newest readings, or `None` when there never were any. Called once a pass.
    fn readings(&mut self) -> Option<ChargerReadings>;

    /// Sets the switch. Called when it changes, and every 10 ms while it does not: a board may switch off by itself when the
    /// calls stop. [`ChargeDrive::Off`] takes effect before this returns.
    fn drive(&mut self, drive: ChargeDrive);

    /// Asks the dock for current, or stops asking. Called when it changes. A board whose dock needs no asking does nothing.
    fn ask_dock(&mut self, request: DockRequest);
}
