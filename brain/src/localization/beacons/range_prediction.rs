//! Predicts the range to a beacon.

use crate::model::geometry::{Point2, Pose2};

/// Distance from the middle of a hop to a beacon, and its derivatives by the pose at the end of the hop.
#[derive(Clone, Copy, Debug)]
pub(super) struct RangePrediction {
    pub(super) away_m: f64,
    pub(super) by_x: f64,
    pub(super) by_y: f64,
    pub(super) by_heading: f64,
    /// By the place of the antenna on the robot, forward and to the left.
    pub(super) by_antenna: [f64; 2],
}

impl RangePrediction {
    pub(super) fn new(pose: Pose2, middle: Point2, beacon: Point2) -> Self {
        let from = pose.transform(middle);
        let (dx, dy) = (from.x_m - beacon.x_m, from.y_m - beacon.y_m);
        let away_m = libm::sqrt(dx * dx + dy * dy).max(0.05);
        let (sin, cos) = libm::sincos(pose.heading_rad);
        let (by_x, by_y) = (dx / away_m, dy / away_m);
        // When the pose turns, the middle moves at a right angle to its direction from the pose.
        let (ox, oy) = (from.x_m - pose.x_m, from.y_m - pose.y_m);
        Self {
            away_m,
            by_x,
            by_y,
            by_heading: by_y * ox - by_x * oy,
            by_antenna: [cos * by_x + sin * by_y, cos * by_y - sin * by_x],
        }
    }
}
