//! Times of driving and turning.

use super::settings::PlanSettings;
use crate::navigation::configuration_space::ConfigurationSpace;
use crate::navigation::heading::{heading_rad, turn_rad};

/// Headings at the ends of a path, radians; `None` = the path does not depend on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct EndHeadings {
    /// Heading of the robot at the start.
    pub(super) start_rad: Option<f64>,
    /// Direction in which the other end would be left; the path ends opposite to it.
    pub(super) leave_rad: Option<f64>,
}

/// Time of a path over cells, turns at its ends included.
pub(super) fn path_s(
    space: &ConfigurationSpace,
    path: &[usize],
    ends: EndHeadings,
    settings: &PlanSettings,
) -> f32 {
    let mut heading = ends.start_rad;
    let (mut length_m, mut turned_rad) = (0.0, 0.0);
    for pair in path.windows(2).filter(|pair| pair[0] != pair[1]) {
        let (from, to) = (space.point(pair[0]), space.point(pair[1]));
        let next = heading_rad(from, to);
        turned_rad += heading.map_or(0.0, |now| turn_rad(now, next));
        heading = Some(next);
        length_m += from.distance_m(to);
    }
    if let (Some(now), Some(back)) = (heading, ends.leave_rad) {
        turned_rad += turn_rad(now, back + core::f64::consts::PI);
    }
    let drive_s = length_m / settings.cruise_m_per_s;
    (drive_s + turned_rad / settings.turn_rad_per_s) as f32
}
