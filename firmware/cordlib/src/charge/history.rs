//! What outlives a charge: faults of the last day, and the time of maintenance charging this week.

use crate::rules::charge_history::{DAY_MS, FAULTS, MAINTAIN_MAX_MS};

const WEEK_MS: u32 = 7 * DAY_MS;

/// Ages and sums; they stop counting long before they could wrap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct History {
    fault_ages_ms: [Option<u32>; FAULTS],
    maintained_ms: u32,
    week_ms: u32,
}

/// The age of a fault that there is not, in the kept record.
const NO_FAULT: u32 = u32::MAX;

impl History {
    /// Words in the kept record.
    pub(super) const WORDS: usize = FAULTS + 2;

    /// For the kept record.
    pub(super) fn words(&self) -> [u32; Self::WORDS] {
        let [first, second, third] = self.fault_ages_ms.map(|age| age.unwrap_or(NO_FAULT));
        [first, second, third, self.maintained_ms, self.week_ms]
    }

    /// From the kept record. The time of the reset is not counted, so that no fault is forgotten too early.
    pub(super) fn from_words([first, second, third, maintained_ms, week_ms]: [u32; Self::WORDS]) -> Self {
        Self {
            fault_ages_ms: [first, second, third].map(|age| (age < DAY_MS).then_some(age)),
            maintained_ms,
            week_ms,
        }
    }

    pub(super) const fn new() -> Self {
        Self {
            fault_ages_ms: [None; FAULTS],
            maintained_ms: 0,
            week_ms: 0,
        }
    }

    /// Time passes.
    pub(super) fn pass(&mut self, elapsed_ms: u32) {
        for age in &mut self.fault_ages_ms {
            *age = age
                .map(|ms| ms.saturating_add(elapsed_ms))
                .filter(|ms| *ms < DAY_MS);
        }
        if self.maintained_ms > 0 {
            self.week_ms = self.week_ms.saturating_add(elapsed_ms);
        }
        if self.week_ms >= WEEK_MS {
            self.week_ms = 0;
            self.maintained_ms = 0;
        }
    }

    /// A fault was found.
    pub(super) fn note_fault(&mut self) {
        let place = self
            .fault_ages_ms
            .iter_mut()
            .max_by_key(|age| age.unwrap_or(u32::MAX));
        if let Some(place) = place {
            *place = Some(0);
        }
    }

    /// Whether there were three faults within a day.
    pub(super) fn is_faulty_day(&self) -> bool {
        self.fault_ages_ms.iter().all(Option::is_some)
    }

    /// The pack was maintained.
    pub(super) const fn note_maintained(&mut self, elapsed_ms: u32) {
        self.maintained_ms = self.maintained_ms.saturating_add(elapsed_ms);
    }

    /// Whether the pack may be maintained any more this week.
    pub(super) const fn may_maintain(&self) -> bool {
        self.maintained_ms < MAINTAIN_MAX_MS
    }
}

#[cfg(test)]
mod tests {
    use super::History;

    const HOUR_MS: u32 = 3_600_000;

    #[test]
    fn three_faults_within_a_day_count_and_older_ones_do_not() {
        let mut history = History::new();
        history.note_fault();
        history.pass(13 * HOUR_MS);
        history.note_fault();
        history.pass(10 * HOUR_MS);
        assert!(!history.is_faulty_day());
        history.note_fault();
        assert!(history.is_faulty_day());
        history.pass(2 * HOUR_MS);
        assert!(!history.is_faulty_day(), "the first is a day old");
    }

    #[test]
    fn the_week_of_maintaining_begins_anew() {
        let mut history = History::new();
        for hour in 0..20 {
            assert!(history.may_maintain(), "hour {hour}");
            history.note_maintained(HOUR_MS);
            history.pass(HOUR_MS);
        }
        assert!(!history.may_maintain());
        for _ in 0..147 {
            history.pass(HOUR_MS);
        }
        assert!(!history.may_maintain());
        history.pass(HOUR_MS);
        assert!(history.may_maintain());
    }
}
