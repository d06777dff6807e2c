//! Dense rasters derived from the occupancy grid, updated incrementally.

use super::distance::{DistanceField, grown, window};
use super::occupancy_grid::{CellBox, OccupancyGrid};
use super::{Cell, CellKnowledge, Raster};
use crate::model::gradual::StepBudget;

/// Work of looking up a cell in the tiles.
const LOOK_UP_WORK: usize = 6;

/// Knowledge and distances of all observed cells.
#[derive(Clone, Debug)]
pub(super) struct Derived {
    pub(super) knowledge: Raster<CellKnowledge>,
    pub(super) distance: DistanceField,
}

impl Default for Derived {
    fn default() -> Self {
        Self {
            knowledge: Raster::filled(Cell::default(), 0, 0, CellKnowledge::Unknown),
            distance: DistanceField::default(),
        }
    }
}

impl Derived {
    /// Derives everything from `grid`.
    pub(super) async fn compute(grid: &mut OccupancyGrid, budget: &mut StepBudget) -> Self {
        grid.take_dirty();
        let mut derived = Self::default();
        derived.cover(grid);
        for index in 0..derived.knowledge.values().len() {
            let cell = derived.knowledge.cell(index);
            if let Some(place) = derived.knowledge.values_mut().get_mut(index) {
                *place = grid.at(cell).knowledge();
            }
            budget.spend(LOOK_UP_WORK).await;
        }
        derived.distance = DistanceField::in_steps(&derived.knowledge, budget).await;
        derived
    }

    /// Updates from all dirty cells of `grid`.
    pub(super) fn refresh(&mut self, grid: &mut OccupancyGrid) {
        let changed = grid.take_dirty();
        self.cover(grid);
        let mut solid: Option<CellBox> = None;
        for part in changed {
            if let Some(moved) = self.copy(grid, part) {
                solid = Some(match solid {
                    Some(before) if are_near(before, moved) => before.joined(moved),
                    Some(before) => {
                        self.distance.renew(&self.knowledge, before);
                        moved
                    }
                    None => moved,
                });
            }
        }
        if let Some(last) = solid {
            self.distance.renew(&self.knowledge, last);
        }
    }

    /// Updates from one dirty tile of `grid`, if there is one.
    pub(super) fn refresh_tile(&mut self, grid: &mut OccupancyGrid) {
        let Some(part) = grid.take_dirty_tile() else {
            return;
        };
        self.cover(grid);
        if let Some(solid) = self.copy(grid, part) {
            self.distance.renew(&self.knowledge, solid);
        }
    }

    /// Extends the rasters to the bounds of the grid.
    fn cover(&mut self, grid: &OccupancyGrid) {
        if let Some(bounds) = grid.bounds()
            && window(&self.knowledge) != Some(bounds)
        {
            self.knowledge = grown(&self.knowledge, bounds, CellKnowledge::Unknown);
            self.distance.cover(bounds);
        }
    }

    /// Copies the knowledge of `part`. Returns the box of cells that became or ceased to be occupied.
    fn copy(&mut self, grid: &OccupancyGrid, part: CellBox) -> Option<CellBox> {
        let mut solid: Option<CellBox> = None;
        for y in part.low.y..=part.high.y {
            for x in part.low.x..=part.high.x {
                let cell = Cell { x, y };
                let Some(place) = self.knowledge.get_mut(cell) else {
                    continue;
                };
                let before = core::mem::replace(place, grid.at(cell).knowledge());
                let occupied = |kind: CellKnowledge| kind == CellKnowledge::Occupied;
                if occupied(before) != occupied(*place) {
                    let here = CellBox::of(cell);
                    solid = Some(solid.map_or(here, |moved| moved.joined(here)));
                }
            }
        }
        solid
    }
}

/// Whether updating the joint box costs no more than updating both boxes: each update includes a margin.
fn are_near(one: CellBox, other: CellBox) -> bool {
    let area = |cells: CellBox| {
        let (width, height) = cells.grown(2 * super::distance::FAR_CELLS).size();
        width.saturating_mul(height)
    };
    area(one.joined(other)) <= area(one) + area(other)
}
