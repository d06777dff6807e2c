//! Levels that the outside will put on pins at cycles to come: edges of a serial line, of an encoder.

use super::rate::NEVER;
use crate::pins::{Level, Pin};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The queue; equal cycles keep the order in which they were given.
#[derive(Clone, Debug, Default)]
pub(crate) struct InputQueue {
    waiting: BinaryHeap<Reverse<(u64, u64, Pin, bool)>>,
    given: u64,
}

impl InputQueue {
    pub(crate) fn add(&mut self, cycle: u64, pin: Pin, level: Level) {
        self.waiting
            .push(Reverse((cycle, self.given, pin, level.is_high())));
        self.given += 1;
    }

    /// The cycle of the next one.
    pub(crate) fn next(&self) -> u64 {
        self.waiting.peek().map_or(NEVER, |Reverse((cycle, ..))| *cycle)
    }

    pub(crate) fn take(&mut self, cycle: u64) -> Option<(Pin, Level)> {
        if self.next() > cycle {
            return None;
        }
        let Reverse((_, _, pin, high)) = self.waiting.pop()?;
        Some((pin, Level::of(high)))
    }
}
