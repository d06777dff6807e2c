//! Times of driving and turning.

use super::settings::PlanSettings;
use crate::navigation::configuration_space::ConfigurationSpace;
use crate::navigation::heading::{heading_rad, turn_rad};

/// Time of a path over cells that starts with one heading and ends opposite to the direction of leaving its other end.
pub(super) fn path_s(
    space: &ConfigurationSpace,
    path: &[usize],
    (out_rad, back_rad): (Option<f64>, Option<f64>),
    settings: &PlanSettings,
) -> f32 {
    let mut heading = out_rad;
    let (mut length_m, mut turned_rad) = (0.0, 0.0);
    for pair in path.windows(2).filter(|pair| pair[0] != pair[1]) {
        let (from, to) = (space.point(pair[0]), space.point(pair[1]));
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
