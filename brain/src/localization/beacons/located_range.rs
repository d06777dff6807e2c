//! A range to a beacon whose position is known.

use crate::model::geometry::Point2;

/// Mean range of a hop to a beacon whose position is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::localization) struct LocatedRange {
    /// Position of the beacon in the map.
    pub(in crate::localization) at: Point2,
    /// Mean range of the hop, metres.
    pub(in crate::localization) range_m: f64,
    /// Standard deviation of the range, including that of the beacon's position, metres.
    pub(in crate::localization) sigma_m: f64,
}
