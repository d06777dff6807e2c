//! Lays a map over the plan as a whole, as its walls fit best: shifted and turned, never stretched or bent.

use home::{Home, Pose};

use crate::map_quality::wall_error_m;

/// Steps of the search, metres: from about a robot's radius down to a tenth of a cell.
const FIRST_STEP_M: f64 = 0.16;
const LAST_STEP_M: f64 = 0.002;

/// The placing near `plan_from_map` in which the walls are nearest to solid things.
pub(crate) fn aligned(walls: &[(f64, f64)], home: &Home, plan_from_map: Pose) -> Pose {
    let Some((middle, reach_m)) = extent(walls) else {
        return plan_from_map;
    };
    let off_m = |pose: Pose| wall_error_m(walls, home, pose).unwrap_or(f64::INFINITY);
    let mut best = (off_m(plan_from_map), plan_from_map);
    let mut step_m = FIRST_STEP_M;
    while step_m >= LAST_STEP_M {
        // A turn moves what is at the rim by as much as a shift.
        let turn_rad = step_m / reach_m.max(step_m);
        let tries = [
            (step_m, 0.0, 0.0),
            (-step_m, 0.0, 0.0),
            (0.0, step_m, 0.0),
            (0.0, -step_m, 0.0),
            (0.0, 0.0, turn_rad),
            (0.0, 0.0, -turn_rad),
        ];
        let moved = tries
            .map(|by| moved(best.1, middle, by))
            .map(|pose| (off_m(pose), pose));
        let better = moved
            .into_iter()
            .min_by(|one, other| one.0.total_cmp(&other.0))
            .filter(|nearest| nearest.0 < best.0);
        match better {
            Some(nearest) => best = nearest,
            None => step_m *= 0.5,
        }
    }
    best.1
}

/// The middle of some places, and how far they reach from it, root mean square in metres.
fn extent(places: &[(f64, f64)]) -> Option<((f64, f64), f64)> {
    let count = places.len() as f64;
    if places.is_empty() {
        return None;
    }
    let sum = places
        .iter()
        .fold((0.0, 0.0), |sum, place| (sum.0 + place.0, sum.1 + place.1));
    let middle = (sum.0 / count, sum.1 / count);
    let squares = places
        .iter()
        .map(|(x_m, y_m)| (x_m - middle.0).powi(2) + (y_m - middle.1).powi(2));
    Some((middle, (squares.sum::<f64>() / count).sqrt()))
}

/// A placing shifted in the plan and turned about where `middle` of the map lies.
fn moved(plan_from_map: Pose, middle: (f64, f64), (x_m, y_m, turn_rad): (f64, f64, f64)) -> Pose {
    let before = plan_from_map.point(middle.0, middle.1);
    let turned = Pose::new(0.0, 0.0, plan_from_map.heading_rad + turn_rad);
    let after = turned.point(middle.0, middle.1);
    Pose::new(
        before.0 + x_m - after.0,
        before.1 + y_m - after.1,
        turned.heading_rad,
    )
}
