//! Where the body can be.

use super::cell::neighbours;
use super::distance::{squared_cells, window};
use super::flood_fill::FloodFill;
use super::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::{StepBudget, at_once};

/// The start is looked for in this many cells around a point that the body itself cannot be on.
const START_CELLS: i32 = 12;

/// As [`super::Map::reachable`], for knowledge from elsewhere.
#[must_use]
pub fn reachable(knowledge: &Raster<CellKnowledge>, from: Point2, clearance_m: f64) -> Raster<bool> {
    let mut reached = Raster::filled(knowledge.origin(), knowledge.width(), knowledge.height(), false);
    let Some(all) = window(knowledge) else {
        return reached;
    };
    let is_free = |cell: Cell| knowledge.get(cell) == Some(&CellKnowledge::Free);
    let squared = at_once(squared_cells(
        all,
        |cell| !is_free(cell),
        &mut StepBudget::unlimited(),
    ));
    let clearance = clearance_m / CELL_M;
    let least = (clearance * clearance) as f32;
    let is_passable = |place: usize| {
        let is_free = knowledge.values().get(place) == Some(&CellKnowledge::Free);
        is_free && squared.get(place).is_some_and(|there| *there >= least)
    };
    let fits = |cell: Cell| knowledge.index(cell).is_some_and(is_passable);
    let start = nearest(Cell::under(from), &fits);
    let mut fill = FloodFill::over(reached.values().len());
    if let Some(place) = start.and_then(|start| knowledge.index(start)) {
        fill.reach(place);
    }
    let beside = |place: usize| {
        neighbours(knowledge.cell(place))
            .into_iter()
            .filter_map(|cell| knowledge.index(cell))
    };
    while fill.go_on(beside, is_passable).is_some() {}
    reached.values_mut().copy_from_slice(&fill.into_reached());
    reached
}

fn nearest(from: Cell, fits: &impl Fn(Cell) -> bool) -> Option<Cell> {
    let mut best: Option<(i32, Cell)> = None;
    for y in -START_CELLS..=START_CELLS {
        for x in -START_CELLS..=START_CELLS {
            let cell = Cell {
                x: from.x.saturating_add(x),
                y: from.y.saturating_add(y),
            };
            let way = x * x + y * y;
            if best.is_none_or(|(least, _)| way < least) && fits(cell) {
                best = Some((way, cell));
            }
        }
    }
    best.map(|(_, cell)| cell)
}
