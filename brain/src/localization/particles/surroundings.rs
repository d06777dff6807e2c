//! Queries of the filter to a map.

use crate::localization::floor_blocks::FloorBlocks;
use crate::model::geometry::Point2;

/// Queries of the filter to a map.
pub(in crate::localization) trait Surroundings {
    /// Distance to the nearest obstacle, metres; negative inside of one.
    fn clearance_m(&self, at: Point2) -> f64;

    /// Distance to the nearest cliff edge, metres, on either side of it; `None` if there is none.
    fn drop_m(&self, at: Point2) -> Option<f64>;

    /// Whether anything is known of a point.
    fn is_known(&self, at: Point2) -> bool;

    /// Bounds of [`Self::clearance_m`] within a radius of a point, metres: nowhere is it less than the first, or more than the second.
    fn clearance_around_m(&self, at: Point2, radius_m: f64) -> (f64, f64);

    /// Positions spread evenly over the floor where the robot can be.
    fn floor_blocks(&self) -> FloorBlocks;
}
