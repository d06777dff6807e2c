//! Which cells the robot can reach.

use super::cell::neighbours;
use super::distance::{squared_cells, window};
use super::flood_fill::FloodFill;
use super::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::{StepBudget, at_once};

/// When the body does not fit at the start, the nearest cell within this distance is used, cells.
const START_CELLS: i32 = 12;

/// As [`super::Map::reachable`], for any raster of knowledge.
#[must_use]
pub fn reachable(knowledge: &Raster<CellKnowledge>, from: Point2, clearance_m: f64) -> Raster<bool> {
    let budget = &mut StepBudget::unlimited();
    at_once(async {
        let passable = passable(knowledge, clearance_m, budget).await;
        connected(&passable, from, budget).await
    })
}

/// Work to find whether a cell is passable, and to reach one.
const READ_WORK: usize = 1;
const REACH_WORK: usize = 8;

/// Cells that the centre of a body with `clearance_m` around it can take: everything around is free.
pub(super) async fn passable(
    knowledge: &Raster<CellKnowledge>,
    clearance_m: f64,
    budget: &mut StepBudget,
) -> Raster<bool> {
    let mut passable = Raster::filled(knowledge.origin(), knowledge.width(), knowledge.height(), false);
    let Some(all) = window(knowledge) else {
        return passable;
    };
    let is_free = |cell: Cell| knowledge.get(cell) == Some(&CellKnowledge::Free);
    let squared = squared_cells(all, |cell| !is_free(cell), budget).await;
    let clearance = clearance_m / CELL_M;
    let least = (clearance * clearance) as f32;
    let cells = knowledge.values().iter().zip(&squared);
    for (place, (kind, there)) in passable.values_mut().iter_mut().zip(cells) {
        *place = *kind == CellKnowledge::Free && *there >= least;
        budget.spend(READ_WORK).await;
    }
    passable
}

/// The passable cells that are connected with `from`.
pub(super) async fn connected(
    passable: &Raster<bool>,
    from: Point2,
    budget: &mut StepBudget,
) -> Raster<bool> {
    let is_passable = |place: usize| passable.values().get(place) == Some(&true);
    let fits = |cell: Cell| passable.get(cell) == Some(&true);
    let start = nearest(Cell::under(from), &fits);
    let mut fill = FloodFill::over(passable.values().len());
    if let Some(place) = start.and_then(|start| passable.index(start)) {
        fill.reach(place);
    }
    let beside = |place: usize| {
        neighbours(passable.cell(place))
            .into_iter()
            .filter_map(|cell| passable.index(cell))
    };
    while fill.go_on(beside, is_passable).is_some() {
        budget.spend(REACH_WORK).await;
    }
    let mut reached = Raster::filled(passable.origin(), passable.width(), passable.height(), false);
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
            let square = x * x + y * y;
            if best.is_none_or(|(least, _)| square < least) && fits(cell) {
                best = Some((square, cell));
            }
        }
    }
    best.map(|(_, cell)| cell)
}
