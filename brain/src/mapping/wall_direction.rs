//! In which direction most walls of a home stand, if they stand at right angles.
//!
//! Seen along a wall its cells fall on few lines, seen askew they spread over many. So for each direction of a quarter turn the
//! cells of all surfaces are counted line by line, along it and across; the direction with the largest sum of squares is that of
//! the walls (a Hough transform that keeps only its energy).

use core::cell::Cell;
use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use super::cell::neighbours;
use super::{CELL_M, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;

/// Width of the lines, metres: walls on a map are some two cells thick.
const LINE_M: f64 = 2.0 * CELL_M;
/// Directions of the first look in a quarter turn: 1.5 degrees each.
const DIRECTIONS: u32 = 60;
/// The second look: so many steps to each side of the best one, of this many radians (0.1 degrees).
const FINE_STEPS: i32 = 20;
const FINE_RAD: f64 = 0.1 * core::f64::consts::PI / 180.0;
/// Surface cells that are looked at, at most.
const CELLS_MAX: usize = 1_500;
/// Fewer cells tell nothing: two metres of wall.
const CELLS_MIN: usize = 80;
/// The best direction must have this many times the energy of the median one. A round room has 1.04.
const CLEAR: f64 = 1.15;
/// Work of looking for surfaces in a cell, and of counting a cell in one direction.
const LOOK_WORK: usize = 1;
const COUNT_WORK: usize = 2;

/// The direction that was found last, and at which revision of the map.
#[derive(Debug, Default)]
pub(super) struct DirectionAt {
    found: Cell<Option<(u32, Option<f64>)>>,
}

impl DirectionAt {
    /// The direction at a revision, looked for if that is another one than last time.
    pub(super) fn at(&self, revision: u32, look: impl FnOnce() -> Option<f64>) -> Option<f64> {
        if let Some((found_at, direction_rad)) = self.found.get()
            && found_at == revision
        {
            return direction_rad;
        }
        let direction_rad = look();
        self.found.set(Some((revision, direction_rad)));
        direction_rad
    }
}

/// Direction of the walls in radians, above -pi/4 and up to pi/4; `None` when the home does not show one.
pub(crate) async fn wall_direction_rad(
    knowledge: &Raster<CellKnowledge>,
    budget: &mut StepBudget,
) -> Option<f64> {
    let surface = surface(knowledge, budget).await;
    if surface.len() < CELLS_MIN {
        return None;
    }
    let mut lines = Lines::around(&surface);
    let mut looks: Vec<(u64, f64)> = Vec::with_capacity(DIRECTIONS as usize);
    for step in 0..DIRECTIONS {
        let direction_rad = f64::from(step) * FRAC_PI_2 / f64::from(DIRECTIONS);
        looks.push((lines.energy(&surface, direction_rad), direction_rad));
        budget.spend(COUNT_WORK * surface.len()).await;
    }
    looks.sort_unstable_by_key(|look| look.0);
    let (median, _) = *looks.get(looks.len() / 2)?;
    let (most, coarse_rad) = *looks.last()?;
    if (most as f64) < CLEAR * median as f64 {
        return None;
    }
    let mut best = (most, coarse_rad);
    for step in -FINE_STEPS..=FINE_STEPS {
        let direction_rad = coarse_rad + f64::from(step) * FINE_RAD;
        let energy = lines.energy(&surface, direction_rad);
        if energy > best.0 {
            best = (energy, direction_rad);
        }
        budget.spend(COUNT_WORK * surface.len()).await;
    }
    Some(folded_rad(best.1))
}

/// The same direction of a cross, above -pi/4 and up to pi/4.
fn folded_rad(direction_rad: f64) -> f64 {
    let turned = direction_rad.rem_euclid(FRAC_PI_2);
    if turned > FRAC_PI_4 {
        turned - FRAC_PI_2
    } else {
        turned
    }
}

/// Middles of occupied cells beside free ones, evenly thinned out.
async fn surface(knowledge: &Raster<CellKnowledge>, budget: &mut StepBudget) -> Vec<Point2> {
    let mut surface = Vec::new();
    for (index, kind) in knowledge.values().iter().enumerate() {
        if index % knowledge.width() == 0 {
            budget.spend(LOOK_WORK * knowledge.width()).await;
        }
        if *kind != CellKnowledge::Occupied {
            continue;
        }
        let cell = knowledge.cell(index);
        let is_beside_floor = neighbours(cell)
            .into_iter()
            .any(|beside| knowledge.get(beside) == Some(&CellKnowledge::Free));
        if is_beside_floor {
            surface.push(cell.middle());
        }
    }
    let thin = surface.len().div_ceil(CELLS_MAX).max(1);
    surface.into_iter().step_by(thin).collect()
}

/// Counters of the lines in two directions at right angles.
struct Lines {
    middle: Point2,
    half: f64,
    counts: [Vec<u32>; 2],
}

impl Lines {
    /// Enough lines for these points in any direction.
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
        let half = libm::ceil(farthest_m / LINE_M) + 1.0;
        let counts = vec![0; 2 * half as usize + 1];
        Self {
            middle,
            half,
            counts: [counts.clone(), counts],
        }
    }

    /// Sum of the squares of how many points lie on each line along and across a direction.
    fn energy(&mut self, points: &[Point2], direction_rad: f64) -> u64 {
        let (sin, cos) = libm::sincos(direction_rad);
        for counts in &mut self.counts {
            counts.fill(0);
        }
        for point in points {
            let (x, y) = (
                (point.x_m - self.middle.x_m) / LINE_M,
                (point.y_m - self.middle.y_m) / LINE_M,
            );
            for (counts, way) in self.counts.iter_mut().zip([x * cos + y * sin, y * cos - x * sin]) {
                if let Some(count) = counts.get_mut((way + self.half + 0.5) as usize) {
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
    use super::{DirectionAt, folded_rad, wall_direction_rad};
    use crate::mapping::{Cell, CellKnowledge, Raster};
    use crate::model::geometry::{Point2, Pose2};
    use crate::model::gradual::{StepBudget, at_once};

    /// A map of what lies inside of a shape, with a border two cells thick.
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

    /// An L of two rooms, turned.
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
    fn walls_tell_their_direction_to_some_tenths_of_a_degree() {
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
    fn directions_are_those_of_a_cross() {
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
    fn a_direction_is_looked_for_once_in_each_revision() {
        let (direction, looks) = (DirectionAt::default(), core::cell::Cell::new(0));
        let at = |revision, found_rad| {
            direction.at(revision, || {
                looks.set(looks.get() + 1);
                found_rad
            })
        };
        assert_eq!(at(3, Some(0.1)), Some(0.1));
        assert_eq!(at(3, Some(0.2)), Some(0.1));
        assert_eq!(at(4, None), None);
        assert_eq!(at(4, Some(0.3)), None, "that there is none is known, too");
        assert_eq!(looks.get(), 2);
    }
}
