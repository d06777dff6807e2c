//! Time on a millisecond clock that wraps: periods, hold timers, debouncing, and a 64-bit extension.
//!
//! Nothing here compares absolute times or takes a time modulo something. Only differences survive the wrap after 49.7
//! days, and only deadlines survive a slow pass of the loop.

use rvac_units::Tick;

/// Something that is due at a fixed period. A late pass runs it once; missed periods are dropped.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Periodic {
    next: Tick,
}

impl Periodic {
    /// First due at `first`.
    pub(crate) const fn starting_at(first: Tick) -> Self {
        Self { next: first }
    }

    /// Whether it is due now. If so, the next time is `period_ms` after the planned one, or after now if that has passed
    /// as well.
    pub(crate) const fn is_due(&mut self, now: Tick, period_ms: u32) -> bool {
        if !now.reached(self.next) {
            return false;
        }
        let planned = self.next.after(period_ms);
        self.next = if now.reached(planned) {
            now.after(period_ms)
        } else {
            planned
        };
        true
    }
}

/// Measures how long a condition has held without interruption.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HoldTimer {
    since: Option<Tick>,
}

impl HoldTimer {
    /// Takes the condition now; returns whether it has held for `span_ms`.
    #[inline(never)]
    pub(crate) fn for_at_least(&mut self, condition: bool, now: Tick, span_ms: u32) -> bool {
        if !condition {
            self.since = None;
            return false;
        }
        now.since(*self.since.get_or_insert(now)) >= span_ms
    }

    /// Starts measuring anew.
    pub(crate) const fn restart(&mut self) {
        self.since = None;
    }
}

/// An input that must be stable for `SET_MS` to count as true and for `CLEAR_MS` to count as false again.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Debounced<const SET_MS: u32, const CLEAR_MS: u32> {
    active: bool,
    differs: HoldTimer,
}

impl<const SET_MS: u32, const CLEAR_MS: u32> Debounced<SET_MS, CLEAR_MS> {
    /// Takes the raw input and returns the stable one.
    pub(crate) fn update(&mut self, raw: bool, now: Tick) -> bool {
        let span_ms = if raw { SET_MS } else { CLEAR_MS };
        if self.differs.for_at_least(raw != self.active, now, span_ms) {
            self.active = raw;
            self.differs.restart();
        }
        self.active
    }

    /// The stable state.
    pub(crate) const fn is_active(&self) -> bool {
        self.active
    }
}

/// A deadline that clears itself when it has passed. Otherwise it would lie ahead again half a wrap later.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Deadline {
    end: Option<Tick>,
}

impl Deadline {
    /// Not running.
    pub(crate) const NONE: Self = Self { end: None };

    /// Runs until `end`.
    pub(crate) const fn at(end: Tick) -> Self {
        Self { end: Some(end) }
    }

    /// Whether the deadline lies ahead.
    pub(crate) const fn is_running(&self) -> bool {
        self.end.is_some()
    }

    /// Whether it has passed; true once.
    pub(crate) fn has_come(&mut self, now: Tick) -> bool {
        let come = self.end.is_some_and(|end| now.reached(end));
        if come {
            self.end = None;
        }
        come
    }
}

/// Extends the 32-bit clock to 64 bits. It must be advanced at least once in 49.7 days, which the main loop does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LongClock {
    last: Tick,
    total_ms: u64,
}

impl LongClock {
    /// Starts with what the 32-bit clock shows.
    pub(crate) const fn starting_at(now: Tick) -> Self {
        Self {
            last: now,
            total_ms: now.0 as u64,
        }
    }

    /// Milliseconds since reset.
    pub(crate) const fn advance(&mut self, now: Tick) -> u64 {
        self.total_ms = self.total_ms.saturating_add(now.since(self.last) as u64);
        self.last = now;
        self.total_ms
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use super::{Deadline, Debounced, HoldTimer, LongClock, Periodic};
    use rvac_units::Tick;

    const BEFORE_WRAP: Tick = Tick(u32::MAX - 4);

    #[test]
    fn a_period_keeps_its_pace_across_the_wrap_and_drops_what_was_missed() {
        let mut period = Periodic::starting_at(BEFORE_WRAP);
        let due: Vec<u32> = (0..40)
            .filter(|ms| period.is_due(BEFORE_WRAP.after(*ms), 10))
            .collect();
        assert_eq!(due, [0, 10, 20, 30]);
        assert!(period.is_due(BEFORE_WRAP.after(95), 10));
        assert!(!period.is_due(BEFORE_WRAP.after(96), 10));
        assert!(period.is_due(BEFORE_WRAP.after(105), 10));
    }

    #[test]
    fn a_hold_is_broken_by_one_false_sample() {
        let mut hold = HoldTimer::default();
        assert!(!hold.for_at_least(true, BEFORE_WRAP, 10));
        assert!(hold.for_at_least(true, BEFORE_WRAP.after(10), 10));
        assert!(!hold.for_at_least(false, BEFORE_WRAP.after(11), 10));
        assert!(!hold.for_at_least(true, BEFORE_WRAP.after(12), 10));
        assert!(!hold.for_at_least(true, BEFORE_WRAP.after(21), 10));
    }

    #[test]
    fn debouncing_counts_stable_time_only() {
        let mut switch = Debounced::<0, 30>::default();
        assert!(switch.update(true, BEFORE_WRAP));
        assert!(switch.update(false, BEFORE_WRAP.after(1)));
        assert!(switch.update(true, BEFORE_WRAP.after(20)));
        assert!(switch.update(false, BEFORE_WRAP.after(21)));
        assert!(switch.update(false, BEFORE_WRAP.after(50)));
        assert!(!switch.update(false, BEFORE_WRAP.after(51)));
    }

    #[test]
    fn a_deadline_comes_once() {
        let mut deadline = Deadline::at(BEFORE_WRAP.after(10));
        assert!(!deadline.has_come(BEFORE_WRAP.after(9)));
        assert!(deadline.has_come(BEFORE_WRAP.after(10)));
        assert!(!deadline.is_running());
        assert!(!deadline.has_come(BEFORE_WRAP.after(10 + (1 << 31) + 5)));
    }

    #[test]
    fn the_long_clock_counts_through_many_wraps() {
        let mut clock = LongClock::starting_at(Tick(7));
        let mut now = Tick(7);
        for _ in 0..10 {
            now = now.after(1 << 31);
            clock.advance(now);
        }
        assert_eq!(clock.advance(now), 7 + 10 * (1 << 31));
    }
}
