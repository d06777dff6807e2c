//! Count and Compare: a counter at half the clock, and the cycle at which it meets its mark.

/// Cycles of SYSCLK for one count, as a power of two.
const CYCLES_LOG2: u32 = 1;

/// The core timer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct CoreTimer {
    /// Count minus half the cycle, while it runs.
    offset: u32,
    /// Count, while it stands still.
    stopped_at: Option<u32>,
    compare: u32,
    /// Cycle at which Count becomes equal to Compare next; `u64::MAX` while it stands still.
    due: u64,
}

impl CoreTimer {
    pub(super) fn new() -> Self {
        let mut timer = Self {
            offset: 0,
            stopped_at: None,
            compare: 0,
            due: 0,
        };
        timer.plan(0);
        timer
    }

    pub(super) fn count(&self, cycle: u64) -> u32 {
        let running = (cycle >> CYCLES_LOG2) as u32;
        self.stopped_at.unwrap_or(running.wrapping_add(self.offset))
    }

    pub(super) const fn compare(&self) -> u32 {
        self.compare
    }

    /// Cycle of the next match.
    pub(super) const fn due(&self) -> u64 {
        self.due
    }

    pub(super) fn set_count(&mut self, cycle: u64, value: u32) {
        match &mut self.stopped_at {
            Some(count) => *count = value,
            None => self.offset = value.wrapping_sub((cycle >> CYCLES_LOG2) as u32),
        }
        self.plan(cycle);
    }

    pub(super) fn set_compare(&mut self, cycle: u64, value: u32) {
        self.compare = value;
        self.plan(cycle);
    }

    pub(super) fn set_stopped(&mut self, cycle: u64, stopped: bool) {
        if stopped == self.stopped_at.is_some() {
            return;
        }
        let count = self.count(cycle);
        self.stopped_at = stopped.then_some(count);
        if !stopped {
            self.set_count(cycle, count);
        }
        self.plan(cycle);
    }

    /// The match is served; the next one comes a whole turn later.
    pub(super) fn serve(&mut self, cycle: u64) {
        self.plan(cycle.max(self.due));
    }

    /// Looks for the next match after `cycle`. Equal now means equal again after a whole turn.
    fn plan(&mut self, cycle: u64) {
        let distance = self.compare.wrapping_sub(self.count(cycle));
        let counts = match distance {
            0 => 1 << 32,
            _ => u64::from(distance),
        };
        self.due = match self.stopped_at {
            Some(_) => u64::MAX,
            None => ((cycle >> CYCLES_LOG2) + counts) << CYCLES_LOG2,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::CoreTimer;

    #[test]
    fn it_counts_every_second_cycle() {
        let mut timer = CoreTimer::new();
        timer.set_count(1000, 7);
        assert_eq!(
            [1000, 1001, 1002, 1010].map(|cycle| timer.count(cycle)),
            [7, 7, 8, 12]
        );
    }

    #[test]
    fn a_match_is_once_a_turn() {
        let mut timer = CoreTimer::new();
        timer.set_count(100, 0);
        timer.set_compare(100, 40_000);
        assert_eq!(timer.due(), 80_100);
        timer.serve(80_105);
        assert_eq!(timer.due(), 80_100 + (1 << 33));
        timer.set_compare(80_200, 80_000);
        assert_eq!(timer.due(), 160_100);
    }

    #[test]
    fn a_mark_in_the_past_waits_for_the_wrap() {
        let mut timer = CoreTimer::new();
        timer.set_count(0, 1000);
        timer.set_compare(0, 999);
        assert_eq!(timer.due(), 2 * u64::from(u32::MAX));
    }

    #[test]
    fn it_stands_still_and_goes_on() {
        let mut timer = CoreTimer::new();
        timer.set_compare(0, 100);
        timer.set_stopped(20, true);
        assert_eq!((timer.count(500), timer.due()), (10, u64::MAX));
        timer.set_stopped(1000, false);
        assert_eq!((timer.count(1000), timer.due()), (10, 1180));
    }
}
