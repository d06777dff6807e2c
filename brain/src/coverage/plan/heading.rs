//! Angles between directions, and what turning costs on a way.

use super::PlanSettings;
use super::ground::Ground;
use crate::geometry::{Point2, normalize_rad};

/// Direction from one point to another in radians.
pub(super) fn heading_rad(from: Point2, to: Point2) -> f64 {
    libm::atan2(to.y_m - from.y_m, to.x_m - from.x_m)
}

/// Size of the turn from one direction to another, 0..=pi.
pub(super) fn turn_rad(from_rad: f64, to_rad: f64) -> f64 {
    normalize_rad(to_rad - from_rad).abs()
}

/// Time of a way over cells that starts in one direction and ends against the direction of leaving its other end.
pub(super) fn way_s(
    ground: &Ground,
    way: &[usize],
    (out_rad, back_rad): (Option<f64>, Option<f64>),
    settings: &PlanSettings,
) -> f32 {
    let mut heading = out_rad;
    let (mut length_m, mut turned_rad) = (0.0, 0.0);
    for pair in way.windows(2).filter(|pair| pair[0] != pair[1]) {
        let (from, to) = (ground.point(pair[0]), ground.point(pair[1]));
        let next = heading_rad(from, to);
        turned_rad += heading.map_or(0.0, |now| turn_rad(now, next));
        heading = Some(next);
        length_m += from.distance_m(to);
    }
    if let (Some(now), Some(back)) = (heading, back_rad) {
        turned_rad += turn_rad(now, back + core::f64::consts::PI);
    }
    let drive_s = length_m / settings.cruise_m_per_s;
    (drive_s + turned_rad / settings.turn_rad_per_s) as f32
}
