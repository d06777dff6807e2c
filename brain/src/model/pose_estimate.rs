//! A pose and its uncertainty.

use super::geometry::Pose2;

/// Estimated pose of the robot and its uncertainty.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PoseEstimate {
    /// Pose in the map.
    pub pose: Pose2,
    /// Standard deviation of the position along its worst direction, in metres.
    pub sigma_m: f64,
    /// Standard deviation of the heading, in radians.
    pub sigma_rad: f64,
    /// The robot does not know its pose: `pose` is the last reliable one, continued by odometry. Nothing may rely on it.
    pub lost: bool,
    /// Pose by odometry alone, in a frame without jumps. Observations are stored with it, so that the map can be redrawn with
    /// corrected poses.
    pub odom: Pose2,
}

impl PoseEstimate {
    /// Largest uncertainty of a position that is good enough to name a room or to plan a path, metres.
    const SURE_M: f64 = 0.8;

    /// Whether the position is good enough to name a room or to plan a path.
    #[must_use]
    pub fn is_sure(&self) -> bool {
        !self.lost && self.sigma_m <= Self::SURE_M
    }
}
