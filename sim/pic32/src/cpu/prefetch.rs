//! The flash prefetch unit: when a jump has to wait for flash.
//!
//! Model: sixteen lines of four words, the oldest is replaced. Code that runs on from line to line never waits, because a
//! line takes four cycles to execute and at most three to read at two wait states. A taken branch or jump waits for the wait
//! states when its target's line is not among the sixteen. The replacement rule of the chip is not known (there is a
//! register CHELRU); lines locked by software and the lines for data (CHECON.DCSZ) are not modelled: each load from flash
//! waits.

use std::fmt;

/// Lines of the unit.
const LINES: usize = 16;
/// Words of a line, as a power of two.
const WORDS_LOG2: u32 = 2;
/// Lines that flash has, program flash first; a power of two.
const FLASH_LINES: usize = 1 << 15;
/// Lines in a word of the set.
const WORD_LINES: usize = 64;

/// A line that no code has.
const EMPTY: u16 = FLASH_LINES as u16 - 1;

/// Which lines of flash the unit holds.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct PrefetchUnit {
    /// The lines in the order in which they came.
    lines: [u16; LINES],
    oldest: u8,
    /// The same lines as a set, so that one look tells whether a line is there.
    held: [u64; FLASH_LINES / WORD_LINES],
}

impl fmt::Debug for PrefetchUnit {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_list().entries(self.lines).finish()
    }
}

/// The line of the word at `index` of a flash whose first line is `first`.
pub(crate) const fn line_of(first: u16, index: usize) -> u16 {
    first.wrapping_add((index >> WORDS_LOG2) as u16) % FLASH_LINES as u16
}

impl PrefetchUnit {
    pub(crate) const fn new() -> Self {
        Self {
            lines: [EMPTY; LINES],
            oldest: 0,
            held: [0; FLASH_LINES / WORD_LINES],
        }
    }

    /// Execution ran from line `begin` to line `end` and jumps to line `target`. Whether that one is missing.
    #[inline(always)]
    pub(crate) fn jump(&mut self, begin: u16, end: u16, target: u16) -> bool {
        let mut line = begin;
        while line < end {
            line += 1;
            self.misses(line);
        }
        self.misses(target)
    }

    /// Whether the line is missing; then it takes the place of the oldest.
    #[inline(always)]
    pub(crate) fn misses(&mut self, line: u16) -> bool {
        let (word, bit) = place(line);
        let is_missing = self.held[word] & bit == 0;
        if is_missing {
            self.held[word] |= bit;
            let newest = &mut self.lines[usize::from(self.oldest) % LINES];
            let (word, bit) = place(std::mem::replace(newest, line));
            self.held[word] &= !bit;
            self.oldest = self.oldest.wrapping_add(1);
        }
        is_missing
    }
}

/// Where a line is in the set.
#[inline(always)]
const fn place(line: u16) -> (usize, u64) {
    let line = line as usize % FLASH_LINES;
    (line / WORD_LINES, 1 << (line % WORD_LINES))
}

#[cfg(test)]
mod tests {
    use super::{PrefetchUnit, line_of};

    #[test]
    fn a_short_loop_misses_once() {
        let mut unit = PrefetchUnit::new();
        let misses = (0..100).filter(|_| unit.jump(5, 7, 5)).count();
        assert_eq!(misses, 1);
    }

    #[test]
    fn a_loop_longer_than_the_unit_always_misses() {
        let mut unit = PrefetchUnit::new();
        assert!((0..100).all(|_| unit.jump(5, 21, 5)));
        let mut unit = PrefetchUnit::new();
        assert_eq!((0..100).filter(|_| unit.jump(5, 20, 5)).count(), 1);
    }

    #[test]
    fn four_words_are_a_line() {
        assert_eq!([0, 3, 4, 65535].map(|index| line_of(0, index)), [0, 0, 1, 16383]);
    }
}
