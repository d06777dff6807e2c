//! The timer of the processor: a counter at half of its clock and a match that interrupts (section 5).

use crate::clock::Clocks;
use crate::cpu;
use core::sync::atomic::{AtomicU32, Ordering};
use embedded_hal::delay::DelayNs;

/// The counter: 40 MHz at 80 MHz, wraps in 107 s. Compare readings with [`u32::wrapping_sub`].
pub use crate::cpu::count;

/// The core timer's match.
#[derive(Debug)]
pub struct CoreTimer(());

impl CoreTimer {
    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Begins to tick, first after one period. A period is 1000 counts at least and half a turn of the counter at most;
    /// others are brought into that range.
    #[must_use]
    pub fn into_ticker(self, period_counts: u32) -> Ticker {
        let period_counts = period_counts.clamp(1_000, i32::MAX as u32);
        let next = cpu::count().wrapping_add(period_counts);
        cpu::set_compare(next);
        Ticker { period_counts, next }
    }
}

/// A regular tick. Its average has no error: a late handler does not shift the ticks after it.
#[derive(Debug)]
pub struct Ticker {
    period_counts: u32,
    /// The match that is waited for.
    next: u32,
}

impl Ticker {
    /// For the handler of [`crate::interrupt::vector::CORE_TIMER`]: sets the next match, clears the source and returns how
    /// many periods have ended since the last call; usually 1, more when the handler came late, 0 when it came early.
    ///
    /// A match that already lies behind the counter would come only after a whole turn of it (107 s); so ticks that were
    /// missed are skipped and counted here.
    pub fn advance(&mut self) -> u32 {
        let mut ended = 0;
        // Matches may pass while this runs, so check again after each change.
        while self.is_behind() {
            let behind = cpu::count().wrapping_sub(self.next);
            let periods = behind.checked_div(self.period_counts).unwrap_or(0) + 1;
            self.next = self.next.wrapping_add(periods.wrapping_mul(self.period_counts));
            cpu::set_compare(self.next);
            ended += periods;
        }
        crate::interrupt::Source::CoreTimer.clear();
        // A match between the last check and the clearing would have been cleared with it.
        if self.is_behind() {
            crate::interrupt::Source::CoreTimer.request();
        }
        ended
    }

    /// Counts in a period.
    #[must_use]
    pub const fn period_counts(&self) -> u32 {
        self.period_counts
    }

    fn is_behind(&self) -> bool {
        cpu::count().wrapping_sub(self.next) <= i32::MAX as u32
    }
}

/// The counter with 64 bits: counts since about the start, for 14,600 years.
///
/// One handler or the main program calls [`Self::update`] at least once in half a turn of the counter (53 s); everybody may
/// read, from every level, without locks: what is kept is the number of half turns, whose parity must agree with the
/// counter's highest bit, and where it does not, a half turn has just begun.
#[derive(Debug)]
pub struct LongCount {
    half_turns: AtomicU32,
}

impl LongCount {
    /// Begins with the counter's first turn.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            half_turns: AtomicU32::new(0),
        }
    }

    /// The count now.
    pub fn now(&self) -> u64 {
        let known = self.half_turns.load(Ordering::Acquire);
        let count = cpu::count();
        join(half_turns_at(known, count), count)
    }

    /// Notes a half turn. One caller only.
    pub fn update(&self) {
        let known = self.half_turns.load(Ordering::Acquire);
        self.half_turns
            .store(half_turns_at(known, cpu::count()), Ordering::Release);
    }
}

impl Default for LongCount {
    fn default() -> Self {
        Self::new()
    }
}

const fn half_turns_at(known: u32, count: u32) -> u32 {
    known.wrapping_add((known & 1) ^ (count >> 31))
}

const fn join(half_turns: u32, count: u32) -> u64 {
    ((half_turns as u64) << 31) | (count & 0x7FFF_FFFF) as u64
}

/// Waiting by polling the counter. Interrupts lengthen it.
#[derive(Clone, Copy, Debug)]
pub struct Delay {
    counts_per_us: u32,
}

impl Delay {
    /// For these clocks.
    #[must_use]
    pub const fn new(clocks: Clocks) -> Self {
        let counts_per_us = clocks.core_timer_hz() / 1_000_000;
        Self {
            counts_per_us: if counts_per_us == 0 { 1 } else { counts_per_us },
        }
    }
}

/// Waits for so many counts at least.
pub(crate) fn wait_counts(counts: u32) {
    let start = cpu::count();
    while cpu::count().wrapping_sub(start) < counts {}
}

impl DelayNs for Delay {
    fn delay_ns(&mut self, ns: u32) {
        // Rounded up to a microsecond above 1 s / 1000, else the product would not fit.
        match ns.checked_mul(self.counts_per_us) {
            Some(product) => wait_counts(product.div_ceil(1_000)),
            None => self.delay_us(ns.div_ceil(1_000)),
        }
    }

    fn delay_us(&mut self, us: u32) {
        const SLICE_US: u32 = 1_000_000;
        let mut left = us;
        while left > SLICE_US {
            wait_counts(SLICE_US * self.counts_per_us);
            left -= SLICE_US;
        }
        wait_counts(left * self.counts_per_us);
    }

    fn delay_ms(&mut self, ms: u32) {
        for _ in 0..ms {
            self.delay_us(1_000);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{CoreTimer, half_turns_at, join};
    use crate::cpu;

    /// The long count never goes back and is never wrong by a turn, whether the half turn was noted before or after the
    /// reading of the counter.
    #[test]
    fn a_half_turn_is_seen_by_its_parity() {
        let rows = [
            (0, 0x0000_0005, 0x0000_0005_u64),
            (0, 0x8000_0000, 0x8000_0000),
            (1, 0x8000_0000, 0x8000_0000),
            (1, 0xFFFF_FFFF, 0xFFFF_FFFF),
            (1, 0x0000_0000, 0x1_0000_0000),
            (2, 0x0000_0000, 0x1_0000_0000),
            (2, 0x8000_0001, 0x1_8000_0001),
        ];
        for (known, count, expected) in rows {
            assert_eq!(
                join(half_turns_at(known, count), count),
                expected,
                "{known} {count:#x}"
            );
        }
    }
    /// However late the handler comes, also over the end of the counter: all periods that ended are counted once, and the
    /// next match lies ahead.
    #[test]
    fn late_ticks_are_counted_and_skipped() {
        const PERIOD: u32 = 40_000;
        let start = u32::MAX - 100_000;
        cpu::set_count(start);
        let mut ticker = CoreTimer::new().into_ticker(PERIOD);
        let first = cpu::compare();
        assert!(first.wrapping_sub(start) - PERIOD < 10);
        let mut ended = 0;
        for (after, expected) in [
            (PERIOD - 1_000, 0),
            (PERIOD + 10, 1),
            (2 * PERIOD + 39_000, 1),
            (3 * PERIOD + 5, 1),
            (10 * PERIOD + 20_000, 7),
            (1_000_000_000, 24_990),
        ] {
            cpu::set_count(start.wrapping_add(after));
            let more = ticker.advance();
            assert_eq!(more, expected, "{after} counts after the start");
            ended += more;
            let ahead = cpu::compare().wrapping_sub(start.wrapping_add(after));
            assert!((1..=PERIOD + 20).contains(&ahead), "{ahead} counts ahead");
        }
        assert_eq!(cpu::compare(), first.wrapping_add(ended * PERIOD));
    }
}
