//! The part of Monte Carlo localization that survives a restart of the daemon.

/// Uncertainty of the pose in the map, and what the robot has learned of its gyro.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrackingCheckpoint {
    /// Standard deviation of the position, metres.
    pub sigma_m: f64,
    /// Standard deviation of the heading, radians.
    pub sigma_rad: f64,
    /// The robot was lost.
    pub lost: bool,
    /// Scale error of the gyro, relative.
    pub gyro_scale: f64,
    /// Bias of the gyro, rad/s.
    pub gyro_bias_rad_per_s: f64,
    /// Informative beams until the pose is confirmed.
    pub unconfirmed_beams: u32,
}
