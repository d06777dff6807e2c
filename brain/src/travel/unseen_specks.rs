//! Cells between free ones that no beam has met.
//!
//! A robot with a few infrared beams sees floor in stripes, and what it has driven over is hardly wider than its body. On a first run cells
//! that nobody has seen therefore lie beside its own track, where its body just fits, and would cut it off from its dock.

use crate::mapping::{CELL_M, CellKnowledge, Raster};
use crate::model::gradual::StepBudget;

/// Widest gap between two free cells that counts as floor, cells. Few things are narrower, and one that is will be touched.
const GAP_CELLS: usize = (0.11 / CELL_M) as usize;
/// Work to look at the cells around one.
const LOOK_WORK: usize = 4;

/// Unknown cells between two free ones of a row or of a column become free; returns whether there were any.
pub(super) async fn close_specks(knowledge: &mut Raster<CellKnowledge>, budget: &mut StepBudget) -> bool {
    let (width, height) = (knowledge.width(), knowledge.height());
    let rows = close_lines(knowledge, (height, width), (width, 1), budget).await;
    let columns = close_lines(knowledge, (width, height), (1, width), budget).await;
    rows || columns
}

/// Closes the gaps in `lines` lines of `length` cells, of which neighbours and cells lie so far apart in the raster.
async fn close_lines(
    knowledge: &mut Raster<CellKnowledge>,
    (lines, length): (usize, usize),
    (between_lines, between_cells): (usize, usize),
    budget: &mut StepBudget,
) -> bool {
    let mut is_closed = false;
    for line in 0..lines {
        let mut last_free = None;
        for place in 0..length {
            let index = |place: usize| line * between_lines + place * between_cells;
            match knowledge.values().get(index(place)) {
                Some(CellKnowledge::Free) => {
                    let gap = last_free.map_or(place..place, |last: usize| last + 1..place);
                    if (1..=GAP_CELLS).contains(&gap.len()) {
                        is_closed = true;
                        for unseen in gap {
                            if let Some(kind) = knowledge.values_mut().get_mut(index(unseen)) {
                                *kind = CellKnowledge::Free;
                            }
                        }
                    }
                    last_free = Some(place);
                }
                Some(CellKnowledge::Unknown) => {}
                _ => last_free = None,
            }
        }
        budget.spend(LOOK_WORK * length).await;
    }
    is_closed
}

#[cfg(test)]
mod tests {
    use super::close_specks;
    use crate::mapping::{Cell, CellKnowledge, Raster};
    use crate::model::gradual::{StepBudget, at_once};

    /// The knowledge that this picture shows: `.` floor, `#` obstacle, a blank unseen.
    fn drawn(rows: &[&str]) -> Raster<CellKnowledge> {
        let width = rows[0].len();
        let mut knowledge = Raster::filled(Cell { x: 0, y: 0 }, width, rows.len(), CellKnowledge::Unknown);
        for (cell, letter) in knowledge
            .values_mut()
            .iter_mut()
            .zip(rows.iter().flat_map(|row| row.chars()))
        {
            *cell = match letter {
                '.' => CellKnowledge::Free,
                '#' => CellKnowledge::Occupied,
                _ => CellKnowledge::Unknown,
            };
        }
        knowledge
    }

    fn closed(rows: &[&str]) -> Vec<String> {
        let mut knowledge = drawn(rows);
        at_once(async { close_specks(&mut knowledge, &mut StepBudget::unlimited()).await });
        let letters: Vec<char> = knowledge
            .values()
            .iter()
            .map(|kind| match kind {
                CellKnowledge::Free => '.',
                CellKnowledge::Occupied => '#',
                _ => ' ',
            })
            .collect();
        letters
            .chunks(rows[0].len())
            .map(|row| row.iter().collect())
            .collect()
    }

    #[test]
    fn gaps_of_a_few_cells_between_floor_become_floor() {
        assert_eq!(closed(&[".    .. .."]), [".........."], "four cells and one");
        assert_eq!(closed(&[".     ..  "]), [".     ..  "], "five cells, and the rim");
        assert_eq!(closed(&[".", " ", "."]), [".", ".", "."], "down a column");
    }

    #[test]
    fn what_is_known_stays_and_parts_the_floor() {
        assert_eq!(closed(&[". # .", "..#.."]), [". # .", "..#.."]);
    }
}
