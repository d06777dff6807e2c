//! The reference map of the particle filter: a copy in which known parts do not change during the job. It takes over parts that
//! were unknown now and then, once a robot with a known pose has seen them.
//!
//! The live map carries the error of the pose. A filter that compared with it would confirm its own errors, and walls and pose
//! would drift together: in an experiment the robot was lost within half an hour.

use super::floor_blocks::FloorBlocks;
use super::particles::Surroundings;
use crate::mapping::{CELL_M, Cell, CellKnowledge, DistanceField, DockLocation, Map, Raster, StoredMap};
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;

/// Cells between two candidate positions: 15 cm.
const PLACE_CELLS: usize = 6;
/// Cells of a block of candidate positions: 60 cm.
const BLOCK_CELLS: usize = 4 * PLACE_CELLS;
/// Least clearance of a candidate position, metres: the body's radius less a cell.
const PLACE_CLEAR_M: f64 = 0.15;
/// A cell is trustworthy when it was seen with at most this standard deviation of the pose, metres.
const SURE_M: f64 = 0.15;
/// Share of the solid cells that must be trustworthy.
const SURE_SHARE: f64 = 0.8;
/// Cells in each direction in which a cliff edge is looked for.
const EDGE_CELLS: i32 = 3;

/// The home as it was known when the job began.
#[derive(Clone, Debug)]
pub(super) struct ReferenceMap {
    distance: DistanceField,
    knowledge: Raster<CellKnowledge>,
    dock: DockLocation,
}

impl ReferenceMap {
    pub(super) fn of(map: &Map) -> Self {
        Self {
            distance: map.distance_field().clone(),
            knowledge: map.knowledge().clone(),
            dock: map.dock_location(),
        }
    }

    /// Loads a stored map in steps.
    pub(super) async fn of_stored(home: StoredMap, budget: &mut StepBudget) -> Self {
        let knowledge = home.knowledge_in_steps(budget).await;
        Self {
            distance: DistanceField::in_steps(&knowledge, budget).await,
            knowledge,
            dock: home.dock_location(),
        }
    }

    /// Whether the robot can localize in the map: a robot with a known pose has seen most of its obstacles. A map that was drawn by
    /// odometry alone shows the same wall at several places.
    pub(super) fn is_trustworthy(map: &Map) -> bool {
        let knowledge = map.knowledge();
        let (mut solid, mut sure) = (0_u32, 0_u32);
        for (index, kind) in knowledge.values().iter().enumerate() {
            if *kind == CellKnowledge::Occupied {
                solid += 1;
                let sigma_m = map.sigma_m(knowledge.cell(index));
                sure += u32::from(sigma_m.is_some_and(|sigma_m| sigma_m <= SURE_M));
            }
        }
        solid > 0 && f64::from(sure) >= SURE_SHARE * f64::from(solid)
    }

    /// Takes over what was unknown and is known in `map` by now.
    pub(super) fn grow(&mut self, map: &Map) {
        let mut knowledge = map.knowledge().clone();
        for index in 0..knowledge.values().len() {
            let cell = knowledge.cell(index);
            let before = self.knowledge.get(cell).copied().unwrap_or_default();
            let is_new = before == CellKnowledge::Unknown;
            if let Some(place) = knowledge.values_mut().get_mut(index) {
                let is_sure = || map.sigma_m(cell).is_some_and(|sigma_m| sigma_m <= SURE_M);
                if *place != before && !(is_new && is_sure()) {
                    *place = before;
                }
            }
        }
        if knowledge != self.knowledge {
            self.distance = DistanceField::new(&knowledge);
            self.knowledge = knowledge;
        }
        self.put_dock(map.dock_location());
    }

    /// Middle of the cell in this column and row of the map, if the robot can be there.
    fn place_at(&self, column: usize, row: usize) -> Option<Point2> {
        let origin = self.knowledge.origin();
        let cell = Cell {
            x: origin.x.saturating_add(i32::try_from(column).ok()?),
            y: origin.y.saturating_add(i32::try_from(row).ok()?),
        };
        let is_free = self.knowledge.get(cell) == Some(&CellKnowledge::Free);
        (is_free && self.distance.cell_m(cell) >= PLACE_CLEAR_M).then(|| cell.middle())
    }

    /// Pose of the robot when it is docked.
    pub(super) fn dock(&self) -> DockLocation {
        self.dock
    }

    /// The dock has another position.
    pub(super) fn put_dock(&mut self, dock: DockLocation) {
        self.dock = dock;
    }
}

impl Surroundings for ReferenceMap {
    fn clearance_m(&self, at: Point2) -> f64 {
        self.distance.at(at)
    }

    fn drop_m(&self, at: Point2) -> Option<f64> {
        edge_m(&self.knowledge, at)
    }

    fn is_known(&self, at: Point2) -> bool {
        let known = self.knowledge.get(Cell::under(at));
        known.is_some_and(|kind| *kind != CellKnowledge::Unknown)
    }

    fn clearance_around_m(&self, at: Point2, radius_m: f64) -> (f64, f64) {
        self.distance.around(at, radius_m)
    }

    fn floor_blocks(&self) -> FloorBlocks {
        let knowledge = &self.knowledge;
        let mut blocks = FloorBlocks::default();
        for row in (0..knowledge.height()).step_by(BLOCK_CELLS) {
            for column in (0..knowledge.width()).step_by(BLOCK_CELLS) {
                let rows = (row..row + BLOCK_CELLS).step_by(PLACE_CELLS);
                let cells = rows.flat_map(|row| {
                    let columns = (column..column + BLOCK_CELLS).step_by(PLACE_CELLS);
                    columns.map(move |column| (column, row))
                });
                blocks.add(cells.filter_map(|(column, row)| self.place_at(column, row)));
            }
        }
        blocks
    }
}

/// Distance to the border between floor and cliff; `None` if there is none near.
fn edge_m(knowledge: &Raster<CellKnowledge>, at: Point2) -> Option<f64> {
    let here = Cell::under(at);
    let is_drop = |cell: Cell| knowledge.get(cell) == Some(&CellKnowledge::Cliff);
    let over_drop = is_drop(here);
    let mut nearest_m: Option<f64> = None;
    for y in here.y.saturating_sub(EDGE_CELLS)..=here.y.saturating_add(EDGE_CELLS) {
        for x in here.x.saturating_sub(EDGE_CELLS)..=here.x.saturating_add(EDGE_CELLS) {
            let cell = Cell { x, y };
            if is_drop(cell) != over_drop {
                let beyond_m = (cell.middle().distance_m(at) - 0.5 * CELL_M).max(0.0);
                nearest_m = Some(nearest_m.map_or(beyond_m, |least: f64| least.min(beyond_m)));
            }
        }
    }
    nearest_m
}

#[cfg(test)]
mod tests {
    use super::edge_m;
    use crate::mapping::{Cell, CellKnowledge, Raster};
    use crate::model::geometry::Point2;

    #[test]
    fn the_distance_to_a_cliff_edge_is_symmetric() {
        let mut knowledge = Raster::filled(Cell { x: 0, y: 0 }, 40, 40, CellKnowledge::Free);
        for y in 0..40 {
            for x in 20..40 {
                *knowledge.get_mut(Cell { x, y }).unwrap() = CellKnowledge::Cliff;
            }
        }
        let at = |x_m: f64| edge_m(&knowledge, Point2 { x_m, y_m: 0.5125 });
        for off_m in [0.0125, 0.0375, 0.0625] {
            assert!(
                (at(0.5 - off_m).unwrap() - off_m).abs() < 1e-9,
                "{off_m} m before the edge"
            );
            assert!(
                (at(0.5 + off_m).unwrap() - off_m).abs() < 1e-9,
                "{off_m} m beyond it"
            );
        }
        assert_eq!(at(0.3), None);
    }
}
