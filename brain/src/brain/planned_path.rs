//! The planned path as it is told: it ends at a wall that was found after the plan was made, because the robot plans anew there.

use crate::mapping::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;

/// Where the robot means to drive, in the map frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlannedPath {
    /// Corners, the nearest first; empty for a strategy that does not plan.
    pub corners: Vec<Point2>,
    /// Length of the rest of the plan, behind a wall that it did not know.
    pub beyond_m: f64,
}

impl PlannedPath {
    /// The plan with these corners as far as this map has no wall in its way.
    pub(super) fn up_to_walls(mut corners: Vec<Point2>, knowledge: &Raster<CellKnowledge>) -> Self {
        let met = corners
            .windows(2)
            .enumerate()
            .find_map(|(index, ends)| match ends {
                [from, to] => Some((index, before_wall(*from, *to, knowledge)?)),
                _ => None,
            });
        let Some((index, last)) = met else {
            return Self {
                corners,
                beyond_m: 0.0,
            };
        };
        let rest = corners.split_off(index + 1);
        let behind = std::iter::once(&last).chain(&rest).zip(&rest);
        let beyond_m = behind.map(|(from, to)| from.distance_m(*to)).sum();
        corners.push(last);
        Self { corners, beyond_m }
    }
}

/// The last place before the first wall on a straight; none where the straight meets no wall.
fn before_wall(from: Point2, to: Point2, knowledge: &Raster<CellKnowledge>) -> Option<Point2> {
    let steps = (from.distance_m(to) / (0.5 * CELL_M)).ceil().max(1.0);
    let at = |step: f64| Point2 {
        x_m: from.x_m + step / steps * (to.x_m - from.x_m),
        y_m: from.y_m + step / steps * (to.y_m - from.y_m),
    };
    let is_wall = |step: &f64| knowledge.get(Cell::under(at(*step))) == Some(&CellKnowledge::Occupied);
    let wall = (0..=steps as u32).map(f64::from).find(is_wall)?;
    Some(at((wall - 1.0).max(0.0)))
}

#[cfg(test)]
mod tests {
    use super::PlannedPath;
    use crate::mapping::{CELL_M, Cell, CellKnowledge, Raster};
    use crate::model::geometry::Point2;

    fn point(x_m: f64, y_m: f64) -> Point2 {
        Point2 { x_m, y_m }
    }

    #[test]
    fn a_path_ends_before_the_wall_and_the_rest_is_measured() {
        let mut knowledge = Raster::filled(Cell { x: 0, y: 0 }, 80, 80, CellKnowledge::Free);
        let corners = vec![point(0.5, 0.5), point(0.5, 1.5), point(1.5, 1.5), point(1.5, 0.5)];
        let free = PlannedPath::up_to_walls(corners.clone(), &knowledge);
        assert_eq!((free.corners, free.beyond_m), (corners.clone(), 0.0));
        for y in 0..80 {
            if let Some(cell) = knowledge.get_mut(Cell::under(point(1.01, CELL_M * f64::from(y)))) {
                *cell = CellKnowledge::Occupied;
            }
        }
        let met = PlannedPath::up_to_walls(corners.clone(), &knowledge);
        assert_eq!(met.corners[..2], corners[..2]);
        let [.., last] = met.corners.as_slice() else {
            panic!("{met:?}")
        };
        assert_eq!(met.corners.len(), 3);
        assert!(
            (1.0 - last.x_m).abs() <= 2.0 * CELL_M && last.y_m == 1.5,
            "{last:?}"
        );
        assert!(
            (met.beyond_m - (1.5 - last.x_m) - 1.0).abs() < 1e-9,
            "{}",
            met.beyond_m
        );
        // What is unknown is no wall: a first run finds out what is there.
        let nothing = Raster::filled(Cell::default(), 0, 0, CellKnowledge::Unknown);
        assert_eq!(
            PlannedPath::up_to_walls(corners.clone(), &nothing).corners,
            corners
        );
    }
}
