//! What changes between two observations: the motion of the robot, and what begins.

use super::onsets::Onsets;

/// Motion between two observations, by odometry, and what the second one begins.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Advance {
    /// Duration in seconds.
    pub time_s: f64,
    /// Distance travelled by the centre in metres, backwards negative.
    pub distance_m: f64,
    /// Change of heading in radians, from the gyro if there is one, else from the wheels.
    pub turn_rad: f64,
    /// Change of heading by the wheels alone, in radians.
    pub wheel_turn_rad: f64,
    /// Change of heading by the gyro alone, in radians, if there is one.
    pub gyro_turn_rad: Option<f64>,
    /// Contacts, cliffs and docking that begin.
    pub onsets: Onsets,
}

impl Advance {
    /// Whether neither wheels nor gyro moved.
    pub(crate) fn is_stationary(&self) -> bool {
        self.distance_m == 0.0 && self.turn_rad == 0.0
    }
}
