//! What of the tracked pose must survive a restart of the daemon.

/// How sure a robot is of its pose in the map of its home, and what it has learnt of its gyro.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrackingCheckpoint {
    /// Standard deviation of the place, metres.
    pub sigma_m: f64,
    /// Standard deviation of the heading, radians.
    pub sigma_rad: f64,
    /// It did not know where it was.
    pub lost: bool,
    /// Error of the gyro's scale, relative.
    pub gyro_scale: f64,
    /// Bias of the gyro, rad/s.
    pub gyro_bias_rad_per_s: f64,
    /// BeamModel that must still tell something before it counts as known where it is.
    pub unconfirmed_beams: u32,
}
