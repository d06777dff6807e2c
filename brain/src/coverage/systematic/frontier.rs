//! What is hoped for in a home that is not known yet.
//!
//! Terms. *Enclosed*: unknown floor with known cells all round it, which the lap along the walls leaves in the middle of
//! each room. *Frontier*: where known floor ends and nothing is known beyond. Both are taken for floor until something is met.

use crate::mapping::{CELL_M, Cell, CellKnowledge, Raster};
use crate::model::gradual::StepBudget;

/// Work of copying a cell, of finding out whether something unknown lies beside it, and of freeing or visiting one.
const COPIES_A_WORK: usize = 8;
const LOOK_WORK: usize = 1;
const VISIT_WORK: usize = 3;
/// Cells that are visited between two looks at the budget.
const VISITS: usize = 256;

/// Cells around what is known that are hoped for beyond it.
pub(super) fn margin_cells(beyond_m: f64) -> usize {
    usize::from(beyond_cells(beyond_m)) + 1
}

fn beyond_cells(beyond_m: f64) -> u16 {
    libm::ceil(beyond_m / CELL_M).clamp(0.0, 400.0) as u16
}

/// Knowledge in which all enclosed floor is free, and unknown floor up to `beyond_m` from what is known to be free. It has
/// [`margin_cells`] more on each side.
pub(super) async fn hopeful(
    knowledge: &Raster<CellKnowledge>,
    beyond_m: f64,
    budget: &mut StepBudget,
) -> Raster<CellKnowledge> {
    let mut hopeful = padded(knowledge, margin_cells(beyond_m));
    budget.spend(hopeful.values().len() / COPIES_A_WORK).await;
    advance_frontier(&mut hopeful, beyond_cells(beyond_m), budget).await;
    fill_enclosed(&mut hopeful, budget).await;
    hopeful
}

/// The same with `cells` more on each side.
fn padded(knowledge: &Raster<CellKnowledge>, cells: usize) -> Raster<CellKnowledge> {
    let shift = i32::try_from(cells).unwrap_or(0);
    let origin = Cell {
        x: knowledge.origin().x.saturating_sub(shift),
        y: knowledge.origin().y.saturating_sub(shift),
    };
    let (width, height) = (knowledge.width() + 2 * cells, knowledge.height() + 2 * cells);
    let mut padded = Raster::filled(origin, width, height, CellKnowledge::Unknown);
    padded.copy_from(knowledge);
    padded
}

/// Frees unknown cells up to so many steps from free ones.
async fn advance_frontier(hopeful: &mut Raster<CellKnowledge>, beyond: u16, budget: &mut StepBudget) {
    let width = hopeful.width();
    let cells = hopeful.values_mut();
    // Free cells whose neighbours are all known lead nowhere.
    let mut frontier = Vec::new();
    for row in 0..cells.len() / width.max(1) {
        let free = (row * width..(row + 1) * width).filter(|index| cells[*index] == CellKnowledge::Free);
        frontier.extend(free.filter(|index| is_beside_unknown(cells, *index, width)));
        budget.spend(LOOK_WORK * width).await;
    }
    for _ in 0..beyond {
        let mut next = Vec::with_capacity(frontier.len());
        for some in frontier.chunks(VISITS) {
            for index in some {
                for beside in beside(*index, width) {
                    if let Some(kind) = cells.get_mut(beside)
                        && *kind == CellKnowledge::Unknown
                    {
                        *kind = CellKnowledge::Free;
                        next.push(beside);
                    }
                }
            }
            budget.spend(VISIT_WORK * some.len()).await;
        }
        frontier = next;
    }
}

fn is_beside_unknown(cells: &[CellKnowledge], index: usize, width: usize) -> bool {
    beside(index, width)
        .into_iter()
        .any(|beside| cells.get(beside) == Some(&CellKnowledge::Unknown))
}

/// Indices of the cells beside one; the margin keeps them in the same row where it matters.
fn beside(index: usize, width: usize) -> [usize; 4] {
    [
        index + 1,
        index + width,
        index.wrapping_sub(1),
        index.wrapping_sub(width),
    ]
}

/// Frees unknown cells that do not hang together with the border of the window.
async fn fill_enclosed(hopeful: &mut Raster<CellKnowledge>, budget: &mut StepBudget) {
    let width = hopeful.width();
    let cells = hopeful.values_mut();
    let mut is_outside = vec![false; cells.len()];
    // The padding hangs together, so one of its corners stands for all of the border.
    let mut waiting = vec![0];
    while !waiting.is_empty() {
        for _ in 0..VISITS {
            let Some(index) = waiting.pop() else { break };
            for beside in beside(index, width) {
                if let Some(seen) = is_outside.get_mut(beside)
                    && !*seen
                    && cells.get(beside) == Some(&CellKnowledge::Unknown)
                {
                    *seen = true;
                    waiting.push(beside);
                }
            }
        }
        budget.spend(VISIT_WORK * VISITS).await;
    }
    for (some, outside) in cells.chunks_mut(VISITS).zip(is_outside.chunks(VISITS)) {
        for (kind, is_outside) in some.iter_mut().zip(outside) {
            if *kind == CellKnowledge::Unknown && !is_outside {
                *kind = CellKnowledge::Free;
            }
        }
        budget.spend(some.len()).await;
    }
}

#[cfg(test)]
mod tests {
    use crate::mapping::{Cell, CellKnowledge, Raster};
    use crate::model::gradual::{StepBudget, at_once};

    fn hopeful(knowledge: &Raster<CellKnowledge>, beyond_m: f64) -> Raster<CellKnowledge> {
        at_once(super::hopeful(knowledge, beyond_m, &mut StepBudget::unlimited()))
    }

    /// A ring of free cells with walls outside of it, and a gap in the wall.
    fn ring() -> Raster<CellKnowledge> {
        let mut knowledge = Raster::filled(Cell { x: 5, y: -3 }, 60, 40, CellKnowledge::Unknown);
        for index in 0..knowledge.values().len() {
            let cell = knowledge.cell(index);
            let (x, y) = (cell.x - 5, cell.y + 3);
            let depth = x.min(y).min(59 - x).min(39 - y);
            let gap = y == 0 && (20..23).contains(&x);
            knowledge.values_mut()[index] = match depth {
                0 if !gap => CellKnowledge::Occupied,
                1..=6 => CellKnowledge::Free,
                _ => CellKnowledge::Unknown,
            };
        }
        knowledge
    }

    #[test]
    fn the_middle_of_a_ring_is_free_and_what_lies_outside_is_not() {
        let hope = hopeful(&ring(), 0.0);
        assert_eq!(hope.get(Cell { x: 35, y: 17 }), Some(&CellKnowledge::Free));
        assert_eq!(hope.get(Cell { x: 26, y: -3 }), Some(&CellKnowledge::Unknown));
        assert_eq!(hope.get(Cell { x: 5, y: 17 }), Some(&CellKnowledge::Occupied));
    }

    #[test]
    fn the_frontier_moves_so_far_and_no_farther() {
        let hope = hopeful(&ring(), 0.1);
        assert_eq!(hope.get(Cell { x: 26, y: -6 }), Some(&CellKnowledge::Free));
        assert_eq!(hope.get(Cell { x: 26, y: -7 }), Some(&CellKnowledge::Unknown));
    }
}
