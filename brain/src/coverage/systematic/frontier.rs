//! What is hoped for in a home that is not known yet.
//!
//! Terms. *Enclosed*: unknown floor with known cells all round it, which the lap along the walls leaves in the middle of
//! each room. *Frontier*: where known floor ends and nothing is known beyond. Both are taken for floor until something is met.

use std::collections::VecDeque;

use crate::mapping::{CELL_M, Cell, CellKnowledge, Raster, neighbours};

/// Knowledge in which all enclosed floor is free, and unknown floor up to `beyond_m` from what is known to be free.
pub(super) fn hopeful(knowledge: &Raster<CellKnowledge>, beyond_m: f64) -> Raster<CellKnowledge> {
    let beyond = libm::ceil(beyond_m / CELL_M).clamp(0.0, 400.0) as u16;
    let mut hopeful = padded(knowledge, usize::from(beyond) + 1);
    advance_frontier(&mut hopeful, beyond);
    fill_enclosed(&mut hopeful);
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
    for (row, values) in knowledge
        .values()
        .chunks_exact(knowledge.width().max(1))
        .enumerate()
    {
        let start = (row + cells) * width + cells;
        if let Some(target) = padded.values_mut().get_mut(start..start + values.len()) {
            target.copy_from_slice(values);
        }
    }
    padded
}

/// Frees unknown cells up to so many steps from free ones.
fn advance_frontier(hopeful: &mut Raster<CellKnowledge>, beyond: u16) {
    let free = hopeful
        .values()
        .iter()
        .enumerate()
        .filter(|(_, kind)| **kind == CellKnowledge::Free);
    let mut waiting: VecDeque<(Cell, u16)> = free.map(|(index, _)| (hopeful.cell(index), 0)).collect();
    while let Some((cell, steps)) = waiting.pop_front() {
        if steps == beyond {
            continue;
        }
        for next in neighbours(cell) {
            if let Some(kind) = hopeful.get_mut(next)
                && *kind == CellKnowledge::Unknown
            {
                *kind = CellKnowledge::Free;
                waiting.push_back((next, steps + 1));
            }
        }
    }
}

/// Frees unknown cells that do not hang together with the border of the window.
fn fill_enclosed(hopeful: &mut Raster<CellKnowledge>) {
    let (width, height) = (hopeful.width(), hopeful.height());
    if width == 0 || height == 0 {
        return;
    }
    let mut is_outside = vec![false; hopeful.values().len()];
    // The padding hangs together, so one of its corners stands for all of the border.
    let mut waiting = vec![hopeful.cell(0)];
    while let Some(cell) = waiting.pop() {
        let Some(index) = hopeful.index(cell) else {
            continue;
        };
        let is_unknown = hopeful.values().get(index) == Some(&CellKnowledge::Unknown);
        if let Some(seen) = is_outside.get_mut(index)
            && is_unknown
            && !core::mem::replace(seen, true)
        {
            waiting.extend(neighbours(cell));
        }
    }
    for (kind, is_outside) in hopeful.values_mut().iter_mut().zip(is_outside) {
        if *kind == CellKnowledge::Unknown && !is_outside {
            *kind = CellKnowledge::Free;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::hopeful;
    use crate::mapping::{Cell, CellKnowledge, Raster};

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
