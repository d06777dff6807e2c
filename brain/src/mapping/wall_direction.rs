//! The dominant direction of the walls, if they are at right angles.
//!
//! Along a wall its cells fall on few lines, at other angles they spread over many. For each direction of a quarter turn this
//! counts the boundary cells per line, along and across. The direction with the largest sum of squares wins (a Hough transform
//! that keeps only its energy).

use core::cell::Cell;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use super::cell::neighbours;
use super::{CELL_M, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;

/// How the main direction of the walls is found.
struct DirectionParameters {
    /// Width of the lines, metres: walls in a map are about two cells thick.
    line_m: f64,
    /// Directions of the coarse search in a quarter turn: 1.5 degrees each.
    coarse_directions: u32,
    /// Steps of the fine search to each side of the best direction.
    fine_steps: i32,
    /// Size of these steps, radians: 0.1 degrees.
    fine_step_rad: f64,
    /// Most boundary cells in the search.
    cells_max: usize,
    /// Fewer cells are no evidence: two metres of wall.
    cells_min: usize,
    /// Least ratio of the best energy to the median one. A round room has 1.04.
    energy_ratio_min: f64,
}

const PARAMETERS: DirectionParameters = DirectionParameters {
    line_m: 2.0 * CELL_M,
    coarse_directions: 60,
    fine_steps: 20,
    fine_step_rad: 0.1 * core::f64::consts::PI / 180.0,
    cells_max: 1_500,
    cells_min: 80,
    energy_ratio_min: 1.15,
};

/// Work of scanning a cell for boundaries, and of counting a cell in one direction.
const SCAN_WORK: usize = 1;
const COUNT_WORK: usize = 2;

/// The wall direction of one revision of the map.
#[derive(Debug, Default)]
pub(super) struct CachedDirection {
    found: Cell<Option<(u32, Option<f64>)>>,
}

impl CachedDirection {
    /// The direction at a revision, computed once per revision.
    pub(super) fn at(&self, revision: u32, compute: impl FnOnce() -> Option<f64>) -> Option<f64> {
        if let Some((found_at, direction_rad)) = self.found.get()
            && found_at == revision
        {
            return direction_rad;
        }
        let direction_rad = compute();
        self.found.set(Some((revision, direction_rad)));
        direction_rad
    }
}

/// Direction of the walls in radians, above -pi/4 and up to pi/4; `None` when there is no dominant one.
pub(crate) async fn wall_direction_rad(
    knowledge: &Raster<CellKnowledge>,
    budget: &mut StepBudget,
) -> Option<f64> {
    let boundary = boundary(knowledge, budget).await;
    if boundary.len() < PARAMETERS.cells_min {
        return None;
    }
    let mut lines = Lines::around(&boundary);
    let mut candidates: Vec<(u64, f64)> = Vec::with_capacity(PARAMETERS.coarse_directions as usize);
    for step in 0..PARAMETERS.coarse_directions {
        let direction_rad = f64::from(step) * FRAC_PI_2 / f64::from(PARAMETERS.coarse_directions);
        candidates.push((lines.energy(&boundary, direction_rad), direction_rad));
        budget.spend(COUNT_WORK * boundary.len()).await;
    }
    candidates.sort_unstable_by_key(|candidate| candidate.0);
    let (median, _) = *candidates.get(candidates.len() / 2)?;
    let (most, coarse_rad) = *candidates.last()?;
    if (most as f64) < PARAMETERS.energy_ratio_min * median as f64 {
        return None;
    }
    let mut best = (most, coarse_rad);
    for step in -PARAMETERS.fine_steps..=PARAMETERS.fine_steps {
        let direction_rad = coarse_rad + f64::from(step) * PARAMETERS.fine_step_rad;
        let energy = lines.energy(&boundary, direction_rad);
        if energy > best.0 {
            best = (energy, direction_rad);
        }
        budget.spend(COUNT_WORK * boundary.len()).await;
    }
    Some(folded_rad(best.1))
}

/// The equivalent direction modulo a quarter turn, above -pi/4 and up to pi/4.
fn folded_rad(direction_rad: f64) -> f64 {
    let turned = direction_rad.rem_euclid(FRAC_PI_2);
    if turned > FRAC_PI_4 {
        turned - FRAC_PI_2
    } else {
        turned
    }
}

/// Centres of occupied cells next to free ones, evenly thinned out.
async fn boundary(knowledge: &Raster<CellKnowledge>, budget: &mut StepBudget) -> Vec<Point2> {
    let mut boundary = Vec::new();
    for (index, kind) in knowledge.values().iter().enumerate() {
        if index % knowledge.width() == 0 {
            budget.spend(SCAN_WORK * knowledge.width()).await;
        }
        if *kind != CellKnowledge::Occupied {
            continue;
        }
        let cell = knowledge.cell(index);
        let is_beside_floor = neighbours(cell)
            .into_iter()
            .any(|beside| knowledge.get(beside) == Some(&CellKnowledge::Free));
        if is_beside_floor {
            boundary.push(cell.middle());
        }
    }
    let stride = boundary.len().div_ceil(PARAMETERS.cells_max).max(1);
    boundary.into_iter().step_by(stride).collect()
}

/// Counters of the lines in two perpendicular directions.
struct Lines {
    middle: Point2,
    half: f64,
    counts: [Vec<u32>; 2],
}

impl Lines {
    /// Counters for these points in any direction.
    fn around(points: &[Point2]) -> Self {
        let count = points.len().max(1) as f64;
        let middle = Point2 {
            x_m: points.iter().map(|point| point.x_m).sum::<f64>() / count,
            y_m: points.iter().map(|point| point.y_m).sum::<f64>() / count,
        };
        let farthest_m = points
            .iter()
            .map(|point| point.distance_m(middle))
            .fold(0.0, f64::max);
        let half = libm::ceil(farthest_m / PARAMETERS.line_m) + 1.0;
        let counts = vec![0; 2 * half as usize + 1];
        Self {
            middle,
            half,
            counts: [counts.clone(), counts],
        }
    }

    /// Sum of the squared numbers of points per line, along and across a direction.
    fn energy(&mut self, points: &[Point2], direction_rad: f64) -> u64 {
        let (sin, cos) = libm::sincos(direction_rad);
        for counts in &mut self.counts {
            counts.fill(0);
        }
        for point in points {
            let (x, y) = (
                (point.x_m - self.middle.x_m) / PARAMETERS.line_m,
                (point.y_m - self.middle.y_m) / PARAMETERS.line_m,
            );
            for (counts, line) in self.counts.iter_mut().zip([x * cos + y * sin, y * cos - x * sin]) {
                if let Some(count) = counts.get_mut((line + self.half + 0.5) as usize) {
                    *count += 1;
                }
            }
        }
        let squares = self.counts.iter().flatten().map(|count| u64::from(*count).pow(2));
        squares.sum()
    }
}

#[cfg(test)]
mod tests {
    use super::{CachedDirection, folded_rad, wall_direction_rad};
    use crate::mapping::{Cell, CellKnowledge, Raster};
    use crate::model::geometry::{Point2, Pose2};
    use crate::model::gradual::{StepBudget, at_once};

    /// A map of the inside of a shape, with a border two cells thick.
    fn map(is_inside: impl Fn(Point2) -> bool) -> Raster<CellKnowledge> {
        let mut knowledge = Raster::filled(Cell { x: -160, y: -160 }, 320, 320, CellKnowledge::Unknown);
        for index in 0..knowledge.values().len() {
            let at = knowledge.cell(index).middle();
            let beside = [(0.05, 0.0), (-0.05, 0.0), (0.0, 0.05), (0.0, -0.05)].map(|(x_m, y_m)| Point2 {
                x_m: at.x_m + x_m,
                y_m: at.y_m + y_m,
            });
            knowledge.values_mut()[index] = if is_inside(at) {
                CellKnowledge::Free
            } else if beside.into_iter().any(&is_inside) {
                CellKnowledge::Occupied
            } else {
                CellKnowledge::Unknown
            };
        }
        knowledge
    }

    fn direction_deg(knowledge: &Raster<CellKnowledge>) -> Option<f64> {
        at_once(wall_direction_rad(knowledge, &mut StepBudget::unlimited())).map(f64::to_degrees)
    }

    /// An L of two rooms, rotated.
    fn home(turned_deg: f64) -> Raster<CellKnowledge> {
        let home_from_map = Pose2 {
            x_m: 0.013,
            y_m: 0.007,
            heading_rad: -turned_deg.to_radians(),
        };
        map(|at| {
            let at = home_from_map.transform(at);
            at.x_m.abs() < 2.4 && at.y_m.abs() < 1.3
                || (at.x_m - 1.4).abs() < 0.9 && (at.y_m - 1.0).abs() < 1.4
        })
    }

    #[test]
    fn the_wall_direction_is_found_to_half_a_degree() {
        for turned_deg in [0.0, 0.7, 3.0, 17.0, 30.0, 44.0, -44.0, -20.0, -1.2] {
            let found_deg = direction_deg(&home(turned_deg)).unwrap();
            assert!((found_deg - turned_deg).abs() < 0.5, "{turned_deg}: {found_deg}");
        }
    }

    #[test]
    fn a_round_room_and_an_empty_map_have_no_direction() {
        assert_eq!(
            direction_deg(&map(|at| at.distance_m(Point2::ORIGIN) < 2.0)),
            None
        );
        assert_eq!(direction_deg(&map(|_| false)), None);
        let nothing = Raster::filled(Cell { x: 0, y: 0 }, 0, 0, CellKnowledge::Unknown);
        assert_eq!(direction_deg(&nothing), None);
    }

    #[test]
    fn directions_are_folded_into_a_quarter_turn() {
        for (direction_deg, folded_deg) in [(10.0_f64, 10.0), (80.0, -10.0), (170.0, -10.0), (-100.0, -10.0)]
        {
            let found_deg = folded_rad(direction_deg.to_radians()).to_degrees();
            assert!(
                (found_deg - folded_deg).abs() < 1e-9,
                "{direction_deg}: {found_deg}"
            );
        }
    }

    #[test]
    fn a_direction_is_computed_once_per_revision() {
        let (direction, candidates) = (CachedDirection::default(), core::cell::Cell::new(0));
        let at = |revision, found_rad| {
            direction.at(revision, || {
                candidates.set(candidates.get() + 1);
                found_rad
            })
        };
        assert_eq!(at(3, Some(0.1)), Some(0.1));
        assert_eq!(at(3, Some(0.2)), Some(0.1));
        assert_eq!(at(4, None), None);
        assert_eq!(at(4, Some(0.3)), None, "that there is none is known, too");
        assert_eq!(candidates.get(), 2);
    }
}
