//! What the filter asks of a map.

use crate::model::geometry::Point2;

/// What the filter asks of a map.
pub(in crate::localization) trait Surroundings {
    /// Distance from a place to the nearest solid thing, in metres; negative inside of one.
    fn clearance_m(&self, at: Point2) -> f64;

    /// Distance from a place to the nearest end of the floor, in metres, on either side of it; `None` if the map has none.
    fn drop_m(&self, at: Point2) -> Option<f64>;

    /// Whether anything is known of a place.
    fn is_known(&self, at: Point2) -> bool;

    /// Places evenly all over the floor on which the robot can stand.
    fn places(&self) -> Vec<Point2>;
}
