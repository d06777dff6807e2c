//! No-go zones in the occupancy grid.

use super::{Access, HomeMap};
use crate::mapping::occupancy_grid::{Flag, OccupancyGrid};
use crate::mapping::zone_cells::cells_of;
use crate::mapping::{Cell, CellKnowledge, Raster};
use crate::model::no_go::NoGo;

impl HomeMap {
    /// Forbids the cells of all no-go zones within the present bounds.
    pub(in crate::mapping) fn paint_no_go(&mut self) {
        let Some(window) = self.bounds() else { return };
        let areas = self.annotations.no_go.values().map(NoGo::area);
        let cells: Vec<Cell> = areas.flat_map(|area| cells_of(area, window)).collect();
        for cell in cells {
            self.flag(cell, Flag::NoGo, Access::Forbidden);
        }
        self.painted = Some(window);
    }

    /// Paints no-go zones again when the bounds have grown.
    pub(in crate::mapping) fn paint_no_go_in_new_tiles(&mut self) {
        if !self.annotations.no_go.is_empty() && self.painted != self.bounds() {
            self.paint_no_go();
        }
    }

    /// Knowledge as if nothing were forbidden, because a virtual wall does not divide a room.
    pub(in crate::mapping) fn knowledge_without_no_go(&self) -> Option<Raster<CellKnowledge>> {
        self.forbids_cells()
            .then(|| without_no_go(self.knowledge(), &self.grid))
    }

    /// Whether any cells may be forbidden, for ever or until the next job.
    pub(in crate::mapping) fn forbids_cells(&self) -> bool {
        !self.annotations.no_go.is_empty() || !self.pockets.is_empty()
    }
}

/// Knowledge as if nothing were forbidden, from this grid.
pub(in crate::mapping) fn without_no_go(
    knowledge: &Raster<CellKnowledge>,
    grid: &OccupancyGrid,
) -> Raster<CellKnowledge> {
    let mut without_no_go = knowledge.clone();
    for index in 0..without_no_go.values().len() {
        let cell = without_no_go.cell(index);
        if let Some(kind) = without_no_go.values_mut().get_mut(index)
            && *kind == CellKnowledge::NoGo
        {
            *kind = grid.knowledge_without(cell, &[Flag::NoGo, Flag::Pocket]);
        }
    }
    without_no_go
}
