//! Sensors of direction and distance.

use rvac_protocol::message::{Gyro, PROXIMITY_SENSORS};

/// Infrared proximity sensors.
pub trait ProximitySensors {
    /// Number of sensors, 0..=8.
    const COUNT: u8;

    /// Closeness from the right side counter-clockwise, 0 = nothing, 255 = touching; unused places are 0.
    fn closeness(&mut self) -> [u8; PROXIMITY_SENSORS];
}

/// A gyro that the board integrates.
pub trait HeadingSensor {
    /// Whether there is one.
    const PRESENT: bool;

    /// Heading since reset and present rate, or `None` while the sensor gives nothing.
    fn heading(&mut self) -> Option<Gyro>;
}
