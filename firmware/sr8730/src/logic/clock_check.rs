//! Checks that the clocks agree (S20).
//!
//! The core timer generates the milliseconds, Timer5 runs from the peripheral bus, and an interrupt counts the ticks.
//! All three depend on one crystal, so their agreement shows that no flipped bit has changed a divider, that no
//! interrupt was lost, and that the core timer runs. The clock monitor detects a failed crystal. A clock that drifts by
//! more than 5 % interrupts the link: the receiver accepts only rates within 5 % of a known one.

/// Milliseconds between two comparisons. Timer5 wraps after 209 ms.
const WINDOW_MS: u32 = 100;
/// Counts of the core timer in a millisecond.
const CORE_PER_MS: u32 = 40_000;
/// Half counts of the core timer for one of Timer5 with a prescaler of 256.
pub const HALVES_PER_COUNT: u32 = 256;
/// Allowed deviation: one in 20, 5 %.
const TOLERANCE: u32 = 20;

/// Readings of all clocks at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClockSample {
    /// Milliseconds, counted by the interrupt.
    pub tick: u32,
    /// The core timer.
    pub core: u32,
    /// Timer5.
    pub bus: u16,
}

/// Compares the clocks.
#[derive(Clone, Copy, Debug)]
pub struct ClockCheck {
    last: ClockSample,
    halves_per_count: u32,
    agreement: ClockAgreement,
}

/// Result of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClockAgreement {
    /// They agree, or there was no comparison yet.
    Even,
    /// They do not.
    Uneven,
}

impl ClockCheck {
    /// Starts now. `halves_per_count` is how many halves of a count of the core timer make one of the other.
    #[must_use]
    pub const fn new(now: ClockSample, halves_per_count: u32) -> Self {
        Self {
            last: now,
            halves_per_count,
            agreement: ClockAgreement::Even,
        }
    }

    /// Called once a millisecond; gives the result of the newest comparison. Later than 200 ms after the last call there is no result, because Timer5 has wrapped;
    /// the watchdog covers that case.
    pub const fn update(&mut self, now: ClockSample) -> ClockAgreement {
        let ticks = now.tick.wrapping_sub(self.last.tick);
        let core = now.core.wrapping_sub(self.last.core);
        if ticks < WINDOW_MS && core < 2 * WINDOW_MS * CORE_PER_MS {
            return self.agreement;
        }
        let bus = now.bus.wrapping_sub(self.last.bus) as u32 * self.halves_per_count / 2;
        self.last = now;
        if ticks > 2 * WINDOW_MS {
            return self.agreement;
        }
        self.agreement = if agree(core, ticks * CORE_PER_MS) && agree(core, bus) {
            ClockAgreement::Even
        } else {
            ClockAgreement::Uneven
        };
        self.agreement
    }
}

const fn agree(left: u32, right: u32) -> bool {
    left.abs_diff(right) <= right / TOLERANCE
}

#[cfg(test)]
mod tests {
    use super::{ClockAgreement, ClockCheck, ClockSample, HALVES_PER_COUNT};

    /// Runs for a second with the given counts in each millisecond.
    fn run(core_per_ms: u32, bus_per_16_ms: u32, ticks_per_16_ms: u32) -> ClockAgreement {
        let start = ClockSample {
            tick: u32::MAX - 50,
            core: u32::MAX - 1_000_000,
            bus: 65_000,
        };
        let mut check = ClockCheck::new(start, HALVES_PER_COUNT);
        let verdicts = (1..=1_000).map(|ms| {
            check.update(ClockSample {
                tick: start.tick.wrapping_add(ms * ticks_per_16_ms / 16),
                core: start.core.wrapping_add(ms * core_per_ms),
                bus: start.bus.wrapping_add((ms * bus_per_16_ms / 16) as u16),
            })
        });
        verdicts.fold(ClockAgreement::Even, |worst, verdict| {
            if verdict == ClockAgreement::Even {
                worst
            } else {
                verdict
            }
        })
    }

    #[test]
    fn clocks_of_one_crystal_agree_across_all_wraps() {
        assert_eq!(run(40_000, 5_000, 16), ClockAgreement::Even);
    }

    #[test]
    fn each_clock_that_goes_astray_is_noticed() {
        assert_eq!(run(43_000, 5_000, 16), ClockAgreement::Uneven);
        assert_eq!(run(40_000, 4_600, 16), ClockAgreement::Uneven);
        assert_eq!(run(40_000, 5_000, 15), ClockAgreement::Uneven);
        assert_eq!(run(40_000, 0, 16), ClockAgreement::Uneven);
        assert_eq!(run(40_000, 5_000, 0), ClockAgreement::Uneven);
    }

    #[test]
    fn a_verdict_stands_until_the_next_comparison() {
        let mut check = ClockCheck::new(ClockSample::default(), HALVES_PER_COUNT);
        let sample = |ms: u32, core: u32| ClockSample {
            tick: ms,
            core,
            bus: (core / HALVES_PER_COUNT * 2) as u16,
        };
        let mut core = 0;
        for ms in 1..=300 {
            core += if ms <= 100 { 50_000 } else { 40_000 };
            let expected = if (100..200).contains(&ms) {
                ClockAgreement::Uneven
            } else {
                ClockAgreement::Even
            };
            assert_eq!(check.update(sample(ms, core)), expected, "{ms} ms");
        }
    }

    #[test]
    fn a_late_look_is_no_verdict() {
        let mut check = ClockCheck::new(ClockSample::default(), HALVES_PER_COUNT);
        let late = ClockSample {
            tick: 500,
            core: 500 * 40_000,
            bus: 0,
        };
        assert_eq!(check.update(late), ClockAgreement::Even);
    }
}
