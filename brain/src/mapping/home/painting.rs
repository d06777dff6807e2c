//! No-go zones in the grid of the home.

use super::{Access, HomeMap};
use crate::mapping::occupancy_grid::Flag;
use crate::mapping::zone_cells::cells_of;
use crate::mapping::{Cell, CellKnowledge, Raster};
use crate::model::no_go::NoGo;

impl HomeMap {
    /// Forbids the cells of all no-go zones within the tiles that there are.
    pub(in crate::mapping) fn paint_no_go(&mut self) {
        let Some(window) = self.bounds() else { return };
        let areas = self.annotations.no_go.values().map(NoGo::area);
        let cells: Vec<Cell> = areas.flat_map(|area| cells_of(area, window)).collect();
        for cell in cells {
            self.flag(cell, Flag::NoGo, Access::Forbidden);
        }
        self.painted = Some(window);
    }

    /// Forbids also what has come into the map since, if anything is forbidden.
    pub(in crate::mapping) fn paint_what_came(&mut self) {
        if !self.annotations.no_go.is_empty() && self.painted != self.bounds() {
            self.paint_no_go();
        }
    }

    /// What would be known if nobody had forbidden anything: a wall that a person draws does not divide a room.
    pub(in crate::mapping) fn knowledge_beneath(&self) -> Option<Raster<CellKnowledge>> {
        if self.annotations.no_go.is_empty() && self.pockets.is_empty() {
            return None;
        }
        let mut beneath = self.knowledge().clone();
        for index in 0..beneath.values().len() {
            let cell = beneath.cell(index);
            if let Some(kind) = beneath.values_mut().get_mut(index)
                && *kind == CellKnowledge::NoGo
            {
                *kind = self.knowledge_without(cell, &[Flag::NoGo, Flag::Pocket]);
            }
        }
        Some(beneath)
    }
}
