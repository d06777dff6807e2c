//! Forbidden floor ahead of a robot that follows no planned path: a spot, a bounce, the search for the dock.

use super::Situation;
use crate::model::geometry::{Point2, TurnSide};
use core::f64::consts::{FRAC_PI_6, PI};

/// The robot turns this far before forbidden floor, metres: what it drives until it stands, and how well it knows its place.
const AHEAD_M: f64 = 0.08;

/// Whether the next hand's breadth leads into a no-go zone or over a virtual wall. A robot that stands in one already, or that
/// does not know its place, is not held back.
pub(crate) fn enters_forbidden(situation: &Situation<'_>) -> bool {
    is_knowing(situation) && leads_in(0.0, situation)
}

/// The smallest turn after which nothing forbidden lies ahead, first to this side; half a turn where there is none, radians.
pub(crate) fn turn_off_forbidden_rad(side: TurnSide, situation: &Situation<'_>) -> f64 {
    let turns =
        (1..=6).flat_map(|step| [1.0, -1.0].map(|sign| sign * side.sign() * f64::from(step) * FRAC_PI_6));
    let mut free = turns.filter(|turn_rad| !leads_in(*turn_rad, situation));
    free.next().unwrap_or(side.sign() * PI)
}

fn is_knowing(situation: &Situation<'_>) -> bool {
    !situation.estimate.lost && !situation.map.is_forbidden(situation.pose.position(), &[])
}

fn leads_in(turn_rad: f64, situation: &Situation<'_>) -> bool {
    let reach_m = situation.config.body.radius_m + AHEAD_M;
    (-2..=2).any(|step| {
        let bearing_rad = turn_rad + f64::from(step) * FRAC_PI_6;
        let at = situation
            .pose
            .transform(Point2::in_direction(bearing_rad, reach_m));
        situation.map.is_forbidden(at, &[])
    })
}
