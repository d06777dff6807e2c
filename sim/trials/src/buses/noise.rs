//! Damage on the lines of a bus.

use rvac_channel::{FaultRates, Pcg32};

/// What happens to one pulse of a clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PulseFault {
    /// Nothing.
    None,
    /// It does not arrive.
    Lost,
    /// Two arrive.
    Doubled,
}

/// Damage drawn from a seed, bit by bit.
#[derive(Clone, Debug)]
pub(super) struct BusNoise {
    random: Pcg32,
    rates: FaultRates,
    /// Bits of a burst that are still to come.
    burst_bits: u32,
}

impl BusNoise {
    pub(super) fn new(seed: u64, rates: FaultRates) -> Self {
        Self {
            random: Pcg32::new(seed),
            rates,
            burst_bits: 0,
        }
    }

    /// The level that arrives. In a burst it is any.
    pub(super) fn bit(&mut self, level: bool) -> bool {
        if self.burst_bits > 0 {
            self.burst_bits -= 1;
            return self.random.below(2) == 1;
        }
        if self.random.happens(self.rates.burst / 8.0) {
            let bytes = 1 + self.random.below(self.rates.run_bytes_max.max(1));
            self.burst_bits = 8 * bytes;
        }
        level != self.random.happens(self.rates.bit_error)
    }

    /// A byte that a serial line would lose is a pulse too few or too many on a clocked one.
    pub(super) fn pulse(&mut self) -> PulseFault {
        if !self.random.happens(self.rates.lost_byte / 8.0) {
            PulseFault::None
        } else if self.random.below(2) == 0 {
            PulseFault::Lost
        } else {
            PulseFault::Doubled
        }
    }

    /// Whether something happens at a bit with the chance of a lost byte.
    pub(super) fn strikes(&mut self) -> bool {
        self.random.happens(self.rates.lost_byte / 8.0)
    }
}
