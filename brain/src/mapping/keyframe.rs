//! Corrections of past poses.

use crate::model::geometry::Pose2;

/// A past pose that was corrected later.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe {
    /// Time of the observation, microseconds.
    pub time_us: u64,
    /// The pose by odometry, [`crate::PoseEstimate::odom`].
    pub odom_from_base: Pose2,
    /// The pose in the map by the best present estimate.
    pub map_from_base: Pose2,
}
