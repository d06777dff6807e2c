//! What turns out later about where the robot was.

use crate::model::geometry::Pose2;

/// A pose of the past that turned out to have been another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe {
    /// Time of the observation at which the robot was there, in microseconds.
    pub time_us: u64,
    /// Where it was by odometry, [`crate::PoseEstimate::odom`].
    pub was: Pose2,
    /// Where it was, as far as is known now.
    pub is: Pose2,
}
