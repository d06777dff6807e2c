//! The parts of a model's board, as far as models differ.

use core::fmt::Debug;

/// Which parts a simulated board has.
pub trait Outfit: Copy + Default + Debug {
    /// Name in the handshake.
    const NAME: &'static str;
    /// Wheel drop switches.
    const WHEEL_DROPS: u8;
    /// Proximity sensors.
    const PROXIMITY: u8;
    /// A gyro that the microcontroller reads.
    const GYRO: bool;
    /// A converter that measures motor currents and the battery.
    const ANALOG: bool;
    /// Receivers of the dock's beams; without them the robot has no dock and no charger of its own.
    const DOCK_BEAMS: u8;
    /// A switch behind the dust box.
    const DUST_BOX: bool;
}

/// Samsung Navibot SR8730.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sr8730Outfit;

impl Outfit for Sr8730Outfit {
    const NAME: &'static str = "sr8730";
    const WHEEL_DROPS: u8 = 2;
    const PROXIMITY: u8 = 7;
    const GYRO: bool = true;
    const ANALOG: bool = true;
    const DOCK_BEAMS: u8 = 4;
    const DUST_BOX: bool = true;
}

/// Vileda Relax: digital lines only, one line a wheel encoder. Its over-current lines and `battery OK` are not
/// modelled, because their thresholds have not been measured.
#[derive(Clone, Copy, Debug, Default)]
pub struct Relax;

impl Outfit for Relax {
    const NAME: &'static str = "relax";
    const WHEEL_DROPS: u8 = 1;
    const PROXIMITY: u8 = 1;
    const GYRO: bool = false;
    const ANALOG: bool = false;
    const DOCK_BEAMS: u8 = 0;
    const DUST_BOX: bool = false;
}
