//! Where the body can be.

use std::collections::VecDeque;

use super::cell::neighbours;
use super::distance::{squared_cells, window};
use super::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::{Pace, at_once};

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
    let squared = at_once(squared_cells(all, |cell| !is_free(cell), &mut Pace::at_once()));
    let clearance = clearance_m / CELL_M;
    let least = (clearance * clearance) as f32;
    let fits = |cell: Cell| {
        knowledge
            .index(cell)
            .is_some_and(|index| is_free(cell) && squared.get(index).is_some_and(|there| *there >= least))
    };
    let Some(start) = nearest(Cell::under(from), &fits) else {
        return reached;
    };
    let mut waiting = VecDeque::from([start]);
    while let Some(cell) = waiting.pop_front() {
        let Some(place) = reached.get_mut(cell) else {
            continue;
        };
        if !core::mem::replace(place, true) {
            waiting.extend(neighbours(cell).into_iter().filter(|next| fits(*next)));
        }
    }
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
