//! The open floor as bits, so that a window across a lane is one word.

use crate::model::gradual::StepBudget;
use crate::navigation::configuration_space::{Axis, Ground};

/// Work of looking at a cell.
const LOOK_WORK: usize = 1;

/// One bit for each cell; each line of cells across an axis is a row of words.
#[derive(Clone, Debug)]
pub(super) struct BitGrid {
    words_per_line: usize,
    words: Vec<u64>,
}

impl BitGrid {
    /// The open floor, with the cells across lanes of this axis side by side.
    pub(super) async fn of_open(ground: &Ground, axis: Axis, budget: &mut StepBudget) -> Self {
        let (lines, across) = match axis {
            Axis::X => (ground.width, ground.height),
            Axis::Y => (ground.height, ground.width),
        };
        let words_per_line = across / 64 + 2;
        let mut bits = Self {
            words_per_line,
            words: vec![0; lines * words_per_line],
        };
        for row in 0..ground.height {
            let open = &ground.open[row * ground.width..(row + 1) * ground.width];
            for column in (0..ground.width).filter(|column| open[*column]) {
                match axis {
                    Axis::X => bits.words[column * words_per_line + row / 64] |= 1 << (row % 64),
                    Axis::Y => bits.words[row * words_per_line + column / 64] |= 1 << (column % 64),
                }
            }
            budget.spend(LOOK_WORK * ground.width).await;
        }
        bits
    }

    /// The lowest bits are those of `start`, `start + 1`, ... on a line.
    pub(super) fn window(&self, line: usize, start: usize) -> u64 {
        let word = line * self.words_per_line + start / 64;
        let shift = start % 64;
        let low = self.words[word] >> shift;
        let high = if shift == 0 {
            0
        } else {
            self.words[word + 1] << (64 - shift)
        };
        low | high
    }

    pub(super) fn clear(&mut self, line: usize, place: usize) {
        self.words[line * self.words_per_line + place / 64] &= !(1 << (place % 64));
    }
}
