//! Sensors on the robot's Linux board: no firmware reads them, the daemon does. They know the world only by the true pose.

mod beacons;
mod gyro;
mod strength;

pub use beacons::{Beacons, LongRanges, Measured};
pub use gyro::BoardGyro;
