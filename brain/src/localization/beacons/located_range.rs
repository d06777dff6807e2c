//! What ranges say to others.

use crate::model::geometry::Point2;

/// What the ranges of a hop say, to somebody who knows where beacons are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::localization) struct LocatedRange {
    /// Place of the beacon in the map.
    pub(in crate::localization) at: Point2,
    /// Mean range of the hop, metres.
    pub(in crate::localization) range_m: f64,
    /// Its deviation, with that of the beacon's place, metres.
    pub(in crate::localization) sigma_m: f64,
}
