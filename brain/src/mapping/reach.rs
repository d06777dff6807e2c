//! Which cells the robot can reach.

use super::distance::{near, window};
use super::flood_fill::FloodFill;
use super::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::{StepBudget, at_once};

/// When the body does not fit at the start, the nearest cell within this distance is used, cells.
const START_CELLS: i32 = 12;

/// As [`super::Map::reachable`], for any raster of knowledge.
#[must_use]
pub fn reachable(knowledge: &Raster<CellKnowledge>, from: Point2, clearance_m: f64) -> Raster<bool> {
    at_once(reachable_in_steps(
        knowledge,
        (from, clearance_m),
        &mut StepBudget::unlimited(),
    ))
}

/// Cells that a body of this radius covers while its centre takes the `reached` ones.
#[must_use]
pub fn covered(reached: &Raster<bool>, radius_m: f64) -> Raster<bool> {
    at_once(covered_in_steps(reached, radius_m, &mut StepBudget::unlimited()))
}

/// As [`covered`], in steps.
pub(crate) async fn covered_in_steps(
    reached: &Raster<bool>,
    radius_m: f64,
    budget: &mut StepBudget,
) -> Raster<bool> {
    let mut covered = Raster::filled(reached.origin(), reached.width(), reached.height(), false);
    if let Some(all) = window(reached) {
        let cells = (radius_m / CELL_M).floor();
        let is_reached = |cell: Cell| reached.get(cell) == Some(&true);
        let near = near(all, is_reached, (cells * cells) as i32, budget).await;
        covered.values_mut().copy_from_slice(&near);
    }
    covered
}

/// As [`reachable`], in steps.
pub(crate) async fn reachable_in_steps(
    knowledge: &Raster<CellKnowledge>,
    (from, clearance_m): (Point2, f64),
    budget: &mut StepBudget,
) -> Raster<bool> {
    let passable = passable(knowledge, clearance_m, budget).await;
    connected(&passable, from, budget).await
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
    let clearance = clearance_m / CELL_M;
    let least = ((clearance * clearance) as f32).ceil() as i32;
    let near = near(all, |cell| !is_free(cell), least - 1, budget).await;
    let cells = knowledge.values().iter().zip(&near);
    for (place, (kind, is_near)) in passable.values_mut().iter_mut().zip(cells) {
        *place = *kind == CellKnowledge::Free && !is_near;
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
    let width = passable.width().max(1);
    let beside = |place: usize| {
        let column = place % width;
        let left = (column > 0).then(|| place - 1);
        let right = (column + 1 < width).then_some(place + 1);
        [left, right, place.checked_sub(width), place.checked_add(width)]
            .into_iter()
            .flatten()
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
    use super::{covered, passable};
    use crate::mapping::{CELL_M, Cell, CellKnowledge, Raster};
    use crate::model::gradual::{StepBudget, at_once};

    fn squared(one: Cell, other: Cell) -> i32 {
        (one.x - other.x).pow(2) + (one.y - other.y).pow(2)
    }

    /// Beside a disc laid over each cell by itself.
    #[test]
    fn a_body_covers_what_a_disc_around_its_places_does() {
        let mut reached = Raster::filled(Cell { x: -3, y: 5 }, 23, 17, false);
        for (index, place) in reached.values_mut().iter_mut().enumerate() {
            *place = index % 37 == 3 || index == 390;
        }
        let covered = covered(&reached, 0.1);
        for (index, is_covered) in covered.values().iter().enumerate() {
            let here = covered.cell(index);
            let mut places = (0..reached.values().len()).filter(|index| reached.values()[*index]);
            let expected = places.any(|place| squared(here, reached.cell(place)) <= 16);
            assert_eq!(*is_covered, expected, "{here:?}");
        }
    }

    /// Beside a disc laid around each cell by itself, for bodies of no size up to those wider than the floor.
    #[test]
    fn a_body_passes_where_a_disc_around_it_is_free() {
        let mut knowledge = Raster::filled(Cell { x: -3, y: 5 }, 41, 19, CellKnowledge::Free);
        for (index, kind) in knowledge.values_mut().iter_mut().enumerate() {
            if index % 113 == 7 || index == 500 {
                *kind = CellKnowledge::Occupied;
            }
        }
        for clearance in [0.0_f64, 1.0, 2.5, 4.0, 7.3, 60.0] {
            let clear = at_once(passable(
                &knowledge,
                clearance * CELL_M,
                &mut StepBudget::unlimited(),
            ));
            for (index, is_clear) in clear.values().iter().enumerate() {
                let here = clear.cell(index);
                let met = (0..knowledge.values().len())
                    .filter(|index| knowledge.values()[*index] != CellKnowledge::Free)
                    .map(|index| squared(here, knowledge.cell(index)))
                    .min();
                let away = f64::from(met.expect("something stands there"));
                let expected = away > 0.0 && away >= clearance * clearance;
                assert_eq!(*is_clear, expected, "{here:?} {clearance}");
            }
        }
    }
}
