//! Sensors that look at the floor.

use rvac_protocol::message::Cliffs;

/// Power of the infrared emitters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Emitters {
    /// Dark: what the receivers see now is ambient light.
    Off,
    /// Lit.
    On,
}

/// Light that each receiver sees, 0 (dark) to 1023 (saturated), whatever the emitters do at that moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CliffLevels {
    /// Left sensor.
    pub left: u16,
    /// Middle sensor.
    pub middle: u16,
    /// Right sensor.
    pub right: u16,
}

/// Cliff sensors: emitters that light the floor and receivers that see it. The difference between lit and dark decides, so
/// that neither sunlight nor a stuck input passes for floor.
pub trait CliffSensors {
    /// Which sensors are fitted.
    const FITTED: Cliffs;

    /// Switches the emitters. They start lit.
    fn set_emitters(&mut self, emitters: Emitters);

    /// What the receivers see now; receivers that are not fitted are ignored.
    fn levels(&mut self) -> CliffLevels;
}
