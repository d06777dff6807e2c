//! How often the host asks a robot that cannot speak up by itself.

/// Pause after a transfer that brought or took something: the next may follow at once.
const BUSY_US: u64 = 0;
/// First pause after one that did not; it doubles with each.
const FIRST_US: u64 = 250;
/// Longest pause, which is the longest that a word of the robot waits.
const LONGEST_US: u64 = 4_000;
/// With an attention line the robot speaks up by itself: asking is only for a line that is broken.
const ATTENDED_US: u64 = 50_000;

/// The pause between two transfers, which follows how much there is to fetch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PollPace {
    pause_us: u64,
    longest_us: u64,
}

impl PollPace {
    /// For a link with or without an attention line.
    #[must_use]
    pub const fn new(has_attention: bool) -> Self {
        Self {
            pause_us: FIRST_US,
            longest_us: if has_attention { ATTENDED_US } else { LONGEST_US },
        }
    }

    /// A transfer is over.
    pub const fn transferred(&mut self, brought_any: bool) {
        self.pause_us = match (brought_any, self.pause_us) {
            (true, _) => BUSY_US,
            (false, BUSY_US) => FIRST_US,
            (false, pause_us) if pause_us * 2 < self.longest_us => pause_us * 2,
            (false, _) => self.longest_us,
        };
    }

    /// Microseconds until the next transfer, if nothing calls for it before.
    #[must_use]
    pub const fn pause_us(self) -> u64 {
        self.pause_us
    }
}

#[cfg(test)]
mod tests {
    use super::PollPace;

    #[test]
    fn the_pause_grows_while_nothing_comes_and_ends_at_once_when_something_does() {
        let mut pace = PollPace::new(false);
        let mut pauses = Vec::new();
        for brought in [false, false, false, false, false, false, true, false] {
            pace.transferred(brought);
            pauses.push(pace.pause_us());
        }
        assert_eq!(pauses, [500, 1_000, 2_000, 4_000, 4_000, 4_000, 0, 250]);
    }
}
