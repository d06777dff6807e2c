//! Presses of a button as people count them: some, a pause, some more.

use crate::matching::Pattern;

/// A press that comes later belongs to the next group.
const PAUSE_US: u64 = 1_400_000;
/// After so long nothing more comes.
const END_US: u64 = 2_500_000;
/// Whoever makes a longer pause has stopped counting.
const PAUSE_MAX_US: u64 = 8_000_000;

/// What was pressed up to now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Heard {
    /// More may come.
    Unfinished,
    /// Two groups and silence.
    Pattern(Pattern),
    /// Nothing that a device was shown.
    Nonsense,
}

/// Counts presses.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rhythm {
    groups: Vec<u8>,
    last_us: u64,
}

impl Rhythm {
    /// The button was pressed.
    pub(crate) fn press(&mut self, now_us: u64) {
        let goes_on = now_us < self.last_us + PAUSE_US;
        self.last_us = now_us;
        // A third group is wrong already, and a fourth not more so.
        let has_room = self.groups.len() < 3;
        match self.groups.last_mut() {
            Some(count) if goes_on => *count = count.saturating_add(1),
            _ if has_room => self.groups.push(1),
            _ => {}
        }
    }

    /// What it makes at `now_us`, with at most so many presses in a group.
    pub(crate) fn heard(&self, now_us: u64, presses_max: u8) -> Heard {
        let silent_us = now_us.saturating_sub(self.last_us);
        if self.groups.iter().any(|count| *count > presses_max) {
            return Heard::Nonsense;
        }
        match *self.groups.as_slice() {
            [] => Heard::Unfinished,
            [_] if silent_us > PAUSE_MAX_US => Heard::Nonsense,
            [first, second] if silent_us > END_US => Heard::Pattern([first, second]),
            [_] | [_, _] => Heard::Unfinished,
            _ => Heard::Nonsense,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Heard, Rhythm};

    /// Presses at these tenths of a second, received at the last one.
    #[track_caller]
    fn check(at: &[u64], heard_at: u64, expected: Heard) {
        let mut rhythm = Rhythm::default();
        for tenths in at {
            rhythm.press(tenths * 100_000);
        }
        assert_eq!(rhythm.heard(heard_at * 100_000, 5), expected, "{at:?}");
    }

    #[test]
    fn two_groups_and_silence_are_a_pattern() {
        check(&[10, 15, 20, 45, 50], 80, Heard::Pattern([3, 2]));
        check(&[10, 22, 34, 60], 90, Heard::Pattern([3, 1]));
        check(&[10, 15, 20, 45, 50], 70, Heard::Unfinished);
    }

    #[test]
    fn what_is_no_pattern_is_refused_early() {
        check(&[], 1000, Heard::Unfinished);
        check(&[10], 60, Heard::Unfinished);
        check(&[10], 91, Heard::Nonsense);
        check(&[10, 11, 12, 13, 14, 15], 15, Heard::Nonsense);
        check(&[10, 40, 70], 70, Heard::Nonsense);
    }
}
