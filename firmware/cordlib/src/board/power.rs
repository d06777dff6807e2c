//! Currents and the battery.

use rvac_protocol::message::{Battery, Currents};

/// Measurement of motor currents.
pub trait CurrentSense {
    /// Whether currents are measured.
    const PRESENT: bool;

    /// The newest readings, or `None` when there are none.
    fn currents(&mut self) -> Option<Currents>;
}

/// Measurement of the battery, and what the charger does.
pub trait BatteryGauge {
    /// Whether the battery is measured.
    const PRESENT: bool;
    /// Whether this firmware controls the charger.
    const CHARGES: bool;

    /// The newest readings, or `None` when there are none.
    fn battery(&mut self) -> Option<Battery>;
}
