//! How long a bit takes.

/// A rate and the time from which its bits are counted, both in ticks of a sixth of a machine cycle.
///
/// The chip divides overflows of a timer by sixteen. A frame begins when that divider rolls over, so one that is written
/// in time follows the stop bit of the last one at once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Rate {
    /// Ticks of a bit; nothing while the timer stands still.
    bit: Option<u64>,
    origin: u64,
}

impl Rate {
    /// Takes over another length of a bit from `tick` on.
    pub(super) fn set(&mut self, bit: Option<u64>, tick: u64) {
        let bit = bit.filter(|bit| *bit > 0);
        if self.bit != bit {
            *self = Self { bit, origin: tick };
        }
    }

    /// Ticks of a bit.
    pub(super) fn bit(&self) -> Option<u64> {
        self.bit
    }

    /// The first rollover after `tick`, and the length of a bit.
    pub(super) fn next_rollover(&self, tick: u64) -> Option<(u64, u64)> {
        let bit = self.bit?;
        let passed = tick.saturating_sub(self.origin) / bit + 1;
        Some((self.origin + passed * bit, bit))
    }
}

#[cfg(test)]
mod tests {
    use super::Rate;

    #[test]
    fn rollovers_keep_their_phase() {
        let mut rate = Rate::default();
        assert_eq!(rate.next_rollover(0), None);
        rate.set(Some(784), 100);
        assert_eq!(rate.next_rollover(100), Some((884, 784)));
        assert_eq!(rate.next_rollover(883), Some((884, 784)));
        rate.set(Some(784), 500);
        assert_eq!(rate.next_rollover(884), Some((1668, 784)));
        rate.set(Some(0), 500);
        assert_eq!(rate.bit(), None);
    }
}
