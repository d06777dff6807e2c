//! Corrections from the proximity sensors and the map for a robot that follows a path: slower towards obstacles ahead, and
//! away from obstacles at the sides.

use super::path_follower::Caution;
use super::{PathFollower, Situation};
use crate::mapping::{CELL_M, Cell, CellKnowledge};
use crate::model::config::ProximityLayout;
use crate::model::geometry::Point2;
use crate::navigation::parameters::{CAUTION, CHASSIS};

/// An obstacle ahead, as the sensors see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ahead {
    /// Straight distance until the robot touches it, metres.
    pub(crate) clear_m: f64,
    /// Its position, in the body frame.
    pub(crate) at: Point2,
}

/// The corrections for the path of `follower`.
pub(crate) fn caution(situation: &Situation<'_>, follower: &PathFollower) -> Caution {
    let layout = &situation.config.sensors.proximity;
    let seen = hits(layout, &situation.observation.proximity);
    if layout.response.near_m.is_some() {
        return Caution {
            offset_m: seen.map(|hit| -CAUTION.near_aside_m.copysign(hit.y_m)).sum(),
            ..Caution::default()
        };
    }
    let radius_m = situation.config.body.radius_m;
    let mut sides = Sides::default();
    for hit in seen {
        sides.note(hit, hit.distance_m(Point2::ORIGIN) - radius_m, radius_m);
    }
    note_map(situation, &mut sides);
    let ahead_m = ahead(situation).map_or(f64::INFINITY, |ahead| ahead.clear_m);
    Caution {
        speed_m_per_s: if follower.turns_on_spot() {
            f64::INFINITY
        } else {
            CAUTION.approach_gain_per_s * (ahead_m - CAUTION.stop_distance_m).max(0.0)
        },
        aside_m: CAUTION.aside_gain * (sides.right_missing_m - sides.left_missing_m),
        ahead_m,
        ..Caution::default()
    }
}

/// The nearest obstacle that the sensors see straight ahead; `None` also for sensors without distance.
pub(crate) fn ahead(situation: &Situation<'_>) -> Option<Ahead> {
    let layout = &situation.config.sensors.proximity;
    if layout.response.near_m.is_some() {
        return None;
    }
    let radius_m = situation.config.body.radius_m;
    hits(layout, &situation.observation.proximity)
        .filter_map(|at| {
            let clear_m = distance_to_contact_m(at, radius_m)?;
            Some(Ahead { clear_m, at })
        })
        .min_by(|one, other| one.clear_m.total_cmp(&other.clear_m))
}

/// Missing gap at each side, metres.
#[derive(Debug, Default)]
struct Sides {
    left_missing_m: f64,
    right_missing_m: f64,
}

impl Sides {
    /// Records an obstacle at a point in the body frame with its gap to the rim.
    fn note(&mut self, at: Point2, gap_m: f64, radius_m: f64) {
        if at.x_m < CAUTION.behind_m || at.y_m.abs() < CAUTION.side_share * radius_m {
            return;
        }
        let missing_m = if at.y_m > 0.0 {
            &mut self.left_missing_m
        } else {
            &mut self.right_missing_m
        };
        *missing_m = missing_m.max(CAUTION.gap_min_m - gap_m.max(0.0));
    }
}

/// Records obstacles of the map at the sides, since the sensors do not see what is between their beams.
fn note_map(situation: &Situation<'_>, sides: &mut Sides) {
    let knowledge = situation.map.knowledge();
    let body_from_map = situation.pose.inverse();
    let radius_m = situation.config.body.radius_m;
    let reach = libm::ceil((radius_m + CAUTION.gap_min_m) / CELL_M) as i32 + 1;
    let middle = Cell::under(situation.pose.position());
    for rise in -reach..=reach {
        for shift in -reach..=reach {
            let cell = Cell {
                x: middle.x.saturating_add(shift),
                y: middle.y.saturating_add(rise),
            };
            if knowledge.get(cell) == Some(&CellKnowledge::Occupied) {
                let at = body_from_map.transform(cell.middle());
                sides.note(
                    at,
                    at.distance_m(Point2::ORIGIN) - radius_m - 0.5 * CELL_M,
                    radius_m,
                );
            }
        }
    }
}

/// Points that the sensors see nearby, in the body frame.
fn hits(layout: &ProximityLayout, levels: &[f32]) -> impl Iterator<Item = Point2> {
    layout.sensors().iter().zip(levels).filter_map(|(sensor, level)| {
        let level = f64::from(*level);
        let distance_m = layout
            .response
            .distance_m(level)
            .filter(|_| level >= CAUTION.level_min)?;
        Some(sensor.transform(Point2 {
            x_m: distance_m,
            y_m: 0.0,
        }))
    })
}

/// Straight distance until the rim touches a point; `None` when it passes beside the point.
pub(super) fn distance_to_contact_m(point: Point2, radius_m: f64) -> Option<f64> {
    let half_m = radius_m - CHASSIS.graze_m;
    (point.x_m > 0.0 && point.y_m.abs() < half_m)
        .then(|| (point.x_m - libm::sqrt(radius_m * radius_m - point.y_m * point.y_m)).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::{CAUTION, Sides, distance_to_contact_m};
    use crate::model::geometry::Point2;

    const RADIUS_M: f64 = 0.175;

    #[test]
    fn only_obstacles_within_the_corridor_limit_the_clearance() {
        let clear_m = |x_m: f64, y_m: f64| distance_to_contact_m(Point2 { x_m, y_m }, RADIUS_M);
        assert!((clear_m(0.3, 0.0).unwrap() - 0.125).abs() < 1e-9);
        assert_eq!(clear_m(0.1, 0.17), None);
        assert_eq!(clear_m(0.1, -0.2), None);
        assert_eq!(clear_m(-0.2, 0.0), None);
    }

    #[test]
    fn only_obstacles_at_a_side_reduce_the_gap_there() {
        let missing = |x_m: f64, y_m: f64, gap_m: f64| {
            let mut sides = Sides::default();
            sides.note(Point2 { x_m, y_m }, gap_m, RADIUS_M);
            (sides.left_missing_m, sides.right_missing_m)
        };
        assert_eq!(missing(0.05, 0.18, 0.0), (CAUTION.gap_min_m, 0.0));
        assert_eq!(
            missing(0.05, -0.18, -0.01),
            (0.0, CAUTION.gap_min_m),
            "no more than touching"
        );
        assert_eq!(missing(0.05, 0.21, 2.0 * CAUTION.gap_min_m), (0.0, 0.0));
        assert_eq!(missing(0.18, 0.02, 0.0), (0.0, 0.0));
        assert_eq!(missing(-0.1, 0.15, 0.0), (0.0, 0.0));
    }
}
