//! A pose and how sure it is.

use super::geometry::Pose2;

/// Where the robot believes to be and how sure it is of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PoseEstimate {
    /// Pose in the map.
    pub pose: Pose2,
    /// Standard deviation of the place along its worst direction, in metres.
    pub sigma_m: f64,
    /// Standard deviation of the heading, in radians.
    pub sigma_rad: f64,
    /// The robot does not know where it is: `pose` is where odometry has carried the last one that was believed, and nothing
    /// may be built on it.
    pub lost: bool,
    /// Pose by odometry alone, in a frame that never jumps: what was seen is kept with it, so that it can be drawn again with
    /// another pose in the map.
    pub odom: Pose2,
}

impl PoseEstimate {
    /// A pose that is no surer than this is in no room and leads nowhere, metres.
    const SURE_M: f64 = 0.8;

    /// Whether the place may be told by the names of the map.
    #[must_use]
    pub fn is_sure(&self) -> bool {
        !self.lost && self.sigma_m <= Self::SURE_M
    }
}
