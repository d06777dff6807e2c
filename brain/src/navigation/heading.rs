//! Angles between directions.

use crate::model::geometry::{Point2, normalize_rad};

/// Direction from one point to another in radians.
pub(crate) fn heading_rad(from: Point2, to: Point2) -> f64 {
    libm::atan2(to.y_m - from.y_m, to.x_m - from.x_m)
}

/// Size of the turn from one direction to another, 0..=pi.
pub(crate) fn turn_rad(from_rad: f64, to_rad: f64) -> f64 {
    normalize_rad(to_rad - from_rad).abs()
}
