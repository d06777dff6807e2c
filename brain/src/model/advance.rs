//! How far the robot moved between two observations.

/// What the robot moved between two observations, by its own account.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Advance {
    /// Time between the two, in seconds.
    pub time_s: f64,
    /// Way of the centre in metres, backwards negative.
    pub distance_m: f64,
    /// Change of heading in radians, from the gyro if there is one, else from the wheels.
    pub turn_rad: f64,
    /// Change of heading that the wheels alone report, in radians.
    pub wheel_turn_rad: f64,
    /// Change of heading that the gyro alone reports, in radians, if there is one.
    pub gyro_turn_rad: Option<f64>,
}

impl Advance {
    /// Neither wheels nor gyro moved.
    pub(crate) fn is_stationary(&self) -> bool {
        self.distance_m == 0.0 && self.turn_rad == 0.0
    }
}
