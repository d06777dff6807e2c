//! Forbidden floor ahead of a robot that follows no planned path: a spot, a bounce, the search for the dock.

use super::Situation;
use crate::model::geometry::Point2;
use core::f64::consts::FRAC_PI_6;

/// The robot turns this far before forbidden floor, metres: what it drives until it stands, and how well it knows its place.
const AHEAD_M: f64 = 0.08;

/// Whether the next hand's breadth leads into a no-go zone or over a virtual wall. A robot that stands in one already, or that
/// does not know its place, is not held back.
pub(crate) fn enters_forbidden(situation: &Situation<'_>) -> bool {
    let is_forbidden = |at| situation.map.is_forbidden(at, &[]);
    if situation.estimate.lost || is_forbidden(situation.pose.position()) {
        return false;
    }
    let reach_m = situation.config.body.radius_m + AHEAD_M;
    (-2..=2).any(|step| {
        let bearing_rad = f64::from(step) * FRAC_PI_6;
        is_forbidden(
            situation
                .pose
                .transform(Point2::in_direction(bearing_rad, reach_m)),
        )
    })
}
