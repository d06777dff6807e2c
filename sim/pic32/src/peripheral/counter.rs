//! A counter that starts again after its period, worked out instead of counted.

use super::rate::{NEVER, Rate};

/// The counting part of a timer, or of a pair of timers. It goes from 0 to `period` and then to 0 again; that step is a
/// *match*. A count above the period (after a write) goes on to the end of the range first, and no match happens there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Counter {
    /// The count at the cycle `since`.
    count: u32,
    since: u64,
    pub(crate) period: u32,
    /// The end of the range.
    last: u32,
    rate: Rate,
}

impl Counter {
    /// 16 bits, standing still at 0 with the longest period.
    pub(crate) const STOPPED: Counter = Counter {
        count: 0,
        since: 0,
        period: 0xFFFF,
        last: 0xFFFF,
        rate: Rate::STOPPED,
    };

    /// The same from 0 to 2^32 - 1.
    pub(crate) const STOPPED_PAIR: Counter = Counter {
        period: u32::MAX,
        last: u32::MAX,
        ..Counter::STOPPED
    };

    /// The same with this count and period.
    pub(crate) const fn with(self, count: u32, period: u32, cycle: u64) -> Counter {
        Counter {
            count,
            period,
            since: cycle,
            ..self
        }
    }

    /// The highest count of its range.
    pub(crate) const fn last(&self) -> u32 {
        self.last
    }

    pub(crate) const fn is_running(&self) -> bool {
        !self.rate.is_stopped() && self.period > 0
    }

    /// The count at this cycle, which is not before the last change.
    pub(crate) fn count_at(&self, cycle: u64) -> u32 {
        if !self.is_running() {
            return self.count;
        }
        let sum = u64::from(self.count) + self.rate.counts_in(cycle.saturating_sub(self.since));
        let (period, last) = (u64::from(self.period), u64::from(self.last));
        let count = if sum <= period || (u64::from(self.count) > period && sum <= last) {
            sum
        } else {
            (sum - self.head()) % (period + 1)
        };
        u32::try_from(count).unwrap_or(u32::MAX)
    }

    /// Where the running through periods begins, in counts from 0: beyond the end of the range for a count above the period.
    fn head(&self) -> u64 {
        if self.count > self.period {
            u64::from(self.last) + 1
        } else {
            0
        }
    }

    /// From now on this count; `rate` may be another one, too.
    pub(crate) fn restart(&mut self, count: u32, rate: Rate, cycle: u64) {
        (self.count, self.rate, self.since) = (count.min(self.last), rate, cycle);
    }

    /// Keeps the count of this cycle as its new beginning: to be done before the period changes.
    pub(crate) fn settle(&mut self, cycle: u64) {
        let count = self.count_at(cycle);
        let rate = self.rate;
        if !rate.is_stopped() {
            // Keeps the phase of the prescaler.
            let whole = rate.counts_in(cycle.saturating_sub(self.since));
            let since = self.since + rate.cycles_for(whole);
            self.restart(count, rate, since.min(cycle));
        }
    }

    pub(crate) const fn rate(&self) -> Rate {
        self.rate
    }

    /// The first cycle after `cycle` at which a period ends.
    pub(crate) fn next_match(&self, cycle: u64) -> u64 {
        self.next_reach(cycle, 0)
    }

    /// The first cycle after `cycle` at which the count becomes `value` by counting; [`NEVER`] for values beyond the period
    /// that are not on the way. The step from the end of the range to 0 counts as reaching nothing.
    pub(crate) fn next_reach(&self, cycle: u64, value: u32) -> u64 {
        if !self.is_running() {
            return NEVER;
        }
        let length = u64::from(self.period) + 1;
        let done = u64::from(self.count) + self.rate.counts_in(cycle.saturating_sub(self.since));
        let head = self.head();
        let sum = if done < head && u64::from(value) > done {
            u64::from(value)
        } else if value > self.period {
            return NEVER;
        } else if done < head {
            // 0 is passed once without a match.
            head + if value == 0 { length } else { u64::from(value) }
        } else {
            let into = (done - head) % length;
            let ahead = (u64::from(value) + length - into) % length;
            done + if ahead == 0 { length } else { ahead }
        };
        self.since
            .saturating_add(self.rate.cycles_for(sum - u64::from(self.count)))
    }

    /// Cycles of a whole period, if that is a whole number.
    pub(crate) fn period_cycles(&self) -> Option<u64> {
        let length = u64::from(self.period) + 1;
        self.rate
            .whole_cycles()
            .filter(|_| self.is_running())
            .map(|cycles| cycles * length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counter(period: u32, rate: Rate, count: u32, since: u64) -> Counter {
        let mut counter = Counter {
            period,
            ..Counter::STOPPED
        };
        counter.restart(count, rate, since);
        counter
    }

    /// Counts step by step: what the closed forms must agree with.
    fn check(counter: Counter, since: u64, cycles_per_count: u64) {
        let (mut count, mut matches, mut reached) = (counter.count, Vec::new(), Vec::new());
        let wanted = 5;
        for cycle in since..since + 400_000 {
            if cycle > since && (cycle - since).is_multiple_of(cycles_per_count) {
                let wraps = count == counter.period || count == counter.last;
                if count == counter.period {
                    matches.push(cycle);
                }
                count = if wraps { 0 } else { count + 1 };
                if count == wanted {
                    reached.push(cycle);
                }
            }
            if cycle % 37 == 0 {
                assert_eq!(counter.count_at(cycle), count, "{counter:?} at {cycle}");
            }
        }
        let follow = |next: &dyn Fn(u64) -> u64| {
            let mut cycle = since;
            std::iter::from_fn(move || {
                cycle = next(cycle);
                (cycle < since + 400_000).then_some(cycle)
            })
            .collect::<Vec<u64>>()
        };
        assert_eq!(follow(&|cycle| counter.next_match(cycle)), matches, "{counter:?}");
        assert_eq!(
            follow(&|cycle| counter.next_reach(cycle, wanted)),
            reached,
            "{counter:?}"
        );
    }

    #[test]
    fn closed_forms_agree_with_counting() {
        let full = Rate::from_hz(80_000_000);
        for (period, count) in [
            (3999, 0),
            (3999, 3999),
            (1, 0),
            (9, 65_500),
            (65_535, 7),
            (65_535, 65_535),
            (4, 5),
        ] {
            for prescaler in [1, 2, 64] {
                check(
                    counter(period, full.divided(prescaler), count, 1000),
                    1000,
                    prescaler,
                );
            }
        }
    }

    #[test]
    fn settling_keeps_the_phase() {
        let mut late = counter(99, Rate::from_hz(80_000_000).divided(64), 3, 10);
        let steady = late;
        late.settle(10 + 64 * 150 + 63);
        for cycle in 10 + 64 * 150 + 63..10 + 64 * 400 {
            assert_eq!(late.count_at(cycle), steady.count_at(cycle));
        }
        assert_eq!(late.next_match(20_000), steady.next_match(20_000));
    }

    #[test]
    fn a_period_of_zero_and_a_stopped_clock_stand_still() {
        let zero = counter(0, Rate::from_hz(80_000_000), 0, 0);
        let stopped = counter(10, Rate::STOPPED, 4, 0);
        assert_eq!((zero.count_at(1 << 30), zero.next_match(5)), (0, NEVER));
        assert_eq!((stopped.count_at(1 << 30), stopped.next_match(5)), (4, NEVER));
    }
}
