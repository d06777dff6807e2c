//! Conversion between cycles of the core and of the time base: they are equal at 80 MHz and differ with other clocks.

use crate::peripheral::Rate;

/// From one moment on, the core runs at one rate.
#[derive(Clone, Copy, Debug)]
pub(super) struct CoreClock {
    rate: Rate,
    /// At 80 MHz: how far the time base is ahead of the core's count.
    ahead: Option<u64>,
    base_since: u64,
    core_since: u64,
}

impl CoreClock {
    pub(super) fn new(rate: Rate, base_since: u64, core_since: u64) -> CoreClock {
        let same = rate.whole_cycles() == Some(1);
        let ahead = same.then(|| base_since.wrapping_sub(core_since));
        CoreClock {
            rate,
            ahead,
            base_since,
            core_since,
        }
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.rate.is_stopped()
    }

    /// The cycle of the time base at which this cycle of the core begins.
    pub(super) fn base_of(&self, core: u64) -> u64 {
        match self.ahead {
            Some(ahead) => core.wrapping_add(ahead),
            None => self
                .base_since
                .saturating_add(self.rate.cycles_for(core - self.core_since)),
        }
    }

    /// The first cycle of the core that begins at this cycle of the time base or later; for the past, when it all
    /// began.
    pub(super) fn core_of(&self, base: u64) -> u64 {
        match (self.ahead, base.saturating_sub(self.base_since)) {
            (_, 0) => self.core_since,
            (Some(ahead), _) => base.wrapping_sub(ahead),
            (None, cycles) => self
                .core_since
                .saturating_add(self.rate.counts_in(cycles - 1))
                .saturating_add(1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_agree_at_all_rates() {
        for hz in [80_000_000, 8_000_000, 32_000, 64_000_000, 60_000_000] {
            let clock = CoreClock::new(Rate::from_hz(hz), 1000, 77);
            for core in 77..300 {
                let base = clock.base_of(core);
                assert_eq!(clock.core_of(base), core, "{hz} Hz");
                assert_eq!(clock.core_of(base + 1), core + 1, "{hz} Hz");
            }
            assert_eq!(clock.core_of(0), 77);
        }
    }
}
