//! Aligns a map with the plan by a rigid transform (shift and rotation) that fits the walls best.

use brain::Point2;
use home::{Home, Pose};

/// Steps of the search, metres: from about a robot's radius down to a tenth of a cell.
const FIRST_STEP_M: f64 = 0.16;
const LAST_STEP_M: f64 = 0.002;

/// The placing near `plan_from_map` in which the walls are nearest to solid things.
pub(crate) fn aligned(walls: &[Point2], home: &Home, plan_from_map: Pose) -> Pose {
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

/// Mean distance of places of the map from what is solid in the plan; `None` without any.
pub(crate) fn wall_error_m(walls: &[Point2], home: &Home, plan_from_map: Pose) -> Option<f64> {
    let off_m = |place: &Point2| {
        let (x_m, y_m) = plan_from_map.point(place.x_m, place.y_m);
        home.clearance_m(x_m, y_m).abs()
    };
    (!walls.is_empty()).then(|| walls.iter().map(off_m).sum::<f64>() / walls.len() as f64)
}

/// The middle of some places, and how far they reach from it, root mean square in metres.
fn extent(places: &[Point2]) -> Option<(Point2, f64)> {
    let count = places.len() as f64;
    if places.is_empty() {
        return None;
    }
    let middle = Point2 {
        x_m: places.iter().map(|place| place.x_m).sum::<f64>() / count,
        y_m: places.iter().map(|place| place.y_m).sum::<f64>() / count,
    };
    let squares = places.iter().map(|place| place.distance_m(middle).powi(2));
    Some((middle, (squares.sum::<f64>() / count).sqrt()))
}

/// A placing shifted in the plan and turned about where `middle` of the map lies.
fn moved(plan_from_map: Pose, middle: Point2, (x_m, y_m, turn_rad): (f64, f64, f64)) -> Pose {
    let before = plan_from_map.point(middle.x_m, middle.y_m);
    let turned = Pose::new(0.0, 0.0, plan_from_map.heading_rad + turn_rad);
    let after = turned.point(middle.x_m, middle.y_m);
    Pose::new(
        before.0 + x_m - after.0,
        before.1 + y_m - after.1,
        turned.heading_rad,
    )
}
