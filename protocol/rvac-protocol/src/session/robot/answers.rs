//! The numbered commands that were executed, so that a repeat is answered again and not executed again.

use heapless::Vec;
use rvac_units::Tick;

use crate::message::{Refusal, Sequence};

/// Commands that are remembered.
const REMEMBERED: usize = crate::session::COMMANDS_UNDER_WAY;
/// After this long a number may be used again: the counter has wrapped, or its sender is gone.
pub(super) const MEMORY_MS: u32 = 10_000;

#[derive(Clone, Copy, Debug)]
struct Remembered {
    sequence: Sequence,
    since: Tick,
    answer: StoredAnswer,
}

#[derive(Clone, Copy, Debug)]
enum StoredAnswer {
    Pending,
    Given(Option<Refusal>),
}

/// What is known of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Known {
    /// New: execute it. It is remembered from now on.
    New,
    /// Being executed; the answer will come.
    Pending,
    /// A repeat: send this answer again.
    Answered(Option<Refusal>),
    /// Older than all remembered numbers: refuse it.
    Forgotten,
}

/// The memory.
#[derive(Clone, Debug, Default)]
pub(super) struct Answers {
    remembered: Vec<Remembered, REMEMBERED>,
}

impl Answers {
    /// Looks a number up and remembers it if it is new.
    pub(super) fn note(&mut self, sequence: Sequence, now: Tick) -> Known {
        self.remembered.retain(|entry| now.since(entry.since) < MEMORY_MS);
        if let Some(entry) = self.remembered.iter().find(|entry| entry.sequence == sequence) {
            return match entry.answer {
                StoredAnswer::Pending => Known::Pending,
                StoredAnswer::Given(refusal) => Known::Answered(refusal),
            };
        }
        let entry = Remembered {
            sequence,
            since: now,
            answer: StoredAnswer::Pending,
        };
        if let Err(entry) = self.remembered.push(entry) {
            match self.lowest_below(sequence) {
                Some(forgotten) => *forgotten = entry,
                None => return Known::Forgotten,
            }
        }
        Known::New
    }

    /// Keeps the answer to a number for its repeats.
    pub(super) fn give(&mut self, sequence: Sequence, refusal: Option<Refusal>) {
        let entry = self
            .remembered
            .iter_mut()
            .find(|entry| entry.sequence == sequence);
        if let Some(entry) = entry {
            entry.answer = StoredAnswer::Given(refusal);
        }
    }

    pub(super) fn clear(&mut self) {
        self.remembered.clear();
    }

    /// The entry with the lowest number, unless `sequence` is lower still.
    fn lowest_below(&mut self, sequence: Sequence) -> Option<&mut Remembered> {
        let mut bound = sequence;
        let mut lowest = None;
        for entry in &mut self.remembered {
            if bound.is_newer_than(entry.sequence) {
                bound = entry.sequence;
                lowest = Some(entry);
            }
        }
        lowest
    }
}

#[cfg(test)]
mod tests {
    use rvac_units::Tick;

    use super::{Answers, Known, MEMORY_MS, REMEMBERED};
    use crate::message::{Refusal, Sequence};

    #[test]
    fn a_repeat_is_known_and_keeps_its_answer() {
        let mut answers = Answers::default();
        assert_eq!(answers.note(Sequence(7), Tick(0)), Known::New);
        assert_eq!(answers.note(Sequence(7), Tick(1)), Known::Pending);
        answers.give(Sequence(7), Some(Refusal::Busy));
        assert_eq!(
            answers.note(Sequence(7), Tick(2)),
            Known::Answered(Some(Refusal::Busy))
        );
    }

    #[test]
    fn what_is_older_than_the_memory_is_not_carried_out_again() {
        let mut answers = Answers::default();
        let first = 65_530_u16;
        for step in 0..=REMEMBERED as u16 {
            assert_eq!(
                answers.note(Sequence(first.wrapping_add(step)), Tick(0)),
                Known::New
            );
        }
        assert_eq!(answers.note(Sequence(first), Tick(0)), Known::Forgotten);
        assert_eq!(
            answers.note(Sequence(first.wrapping_add(1)), Tick(0)),
            Known::Pending
        );
        assert_eq!(answers.note(Sequence(first), Tick(MEMORY_MS)), Known::New);
    }

    #[test]
    fn numbers_may_come_in_any_order() {
        let mut answers = Answers::default();
        for number in [5, 3, 4, 9, 1] {
            assert_eq!(answers.note(Sequence(number), Tick(0)), Known::New);
        }
    }
}
