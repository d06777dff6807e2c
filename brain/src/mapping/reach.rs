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

/// Cells that a body of this radius covers while its centre takes the `reached` ones.
#[must_use]
pub fn covered(reached: &Raster<bool>, radius_m: f64) -> Raster<bool> {
    let mut covered = Raster::filled(reached.origin(), reached.width(), reached.height(), false);
    let Some(all) = window(reached) else {
        return covered;
    };
    let cells = (radius_m / CELL_M).floor();
    let most = (cells * cells) as f32;
    let is_reached = |cell: Cell| reached.get(cell) == Some(&true);
    let squared = at_once(squared_cells(all, is_reached, &mut StepBudget::unlimited()));
    for (place, away) in covered.values_mut().iter_mut().zip(&squared) {
        *place = *away <= most;
    }
    covered
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

#[cfg(test)]
mod tests {
    use super::covered;
    use crate::mapping::{Cell, Raster};

    /// Beside a disc laid over each cell by itself.
    #[test]
    fn a_body_covers_what_a_disc_around_its_places_does() {
        let mut reached = Raster::filled(Cell { x: -3, y: 5 }, 23, 17, false);
        for (index, place) in reached.values_mut().iter_mut().enumerate() {
            *place = index % 37 == 3 || index == 390;
        }
        let covered = covered(&reached, 0.1);
        let near = |one: Cell, other: Cell| (one.x - other.x).pow(2) + (one.y - other.y).pow(2) <= 16;
        for (index, is_covered) in covered.values().iter().enumerate() {
            let here = covered.cell(index);
            let mut places = (0..reached.values().len()).filter(|index| reached.values()[*index]);
            let expected = places.any(|place| near(here, reached.cell(place)));
            assert_eq!(*is_covered, expected, "{here:?}");
        }
    }
}
