//! How fast something counts, in cycles of the machine's 80 MHz time base.

/// Cycles of the time base in a second.
pub const CYCLES_PER_S: u64 = 80_000_000;

/// `counts` counts take `cycles` cycles of the 80 MHz time base. A rate of zero counts stands still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    cycles: u64,
    counts: u64,
}

impl Rate {
    /// Stands still.
    pub const STOPPED: Rate = Rate { cycles: 1, counts: 0 };

    /// So many counts in a second; 0 stands still.
    pub const fn from_hz(hz: u64) -> Rate {
        if hz == 0 {
            return Rate::STOPPED;
        }
        let divisor = greatest_common_divisor(CYCLES_PER_S, hz);
        Rate {
            cycles: CYCLES_PER_S / divisor,
            counts: hz / divisor,
        }
    }

    /// One count for `factor` counts of this rate: a prescaler. `factor` is at least 1.
    pub const fn divided(self, factor: u64) -> Rate {
        if self.counts == 0 {
            return self;
        }
        let cycles = self.cycles * factor;
        let divisor = greatest_common_divisor(cycles, self.counts);
        Rate {
            cycles: cycles / divisor,
            counts: self.counts / divisor,
        }
    }

    /// Counts in a second, rounded down.
    pub const fn hz(self) -> u64 {
        self.counts * CYCLES_PER_S / self.cycles
    }

    /// Cycles of one count, if that is a whole number.
    pub const fn whole_cycles(self) -> Option<u64> {
        if self.counts == 1 { Some(self.cycles) } else { None }
    }

    /// Whether it stands still.
    pub const fn is_stopped(self) -> bool {
        self.counts == 0
    }

    /// How many counts are complete after so many cycles.
    pub const fn counts_in(self, cycles: u64) -> u64 {
        if self.counts == 1 {
            cycles / self.cycles
        } else {
            wide(cycles, self.counts, self.cycles)
        }
    }

    /// After how many cycles so many counts are complete; [`NEVER`] when it stands still.
    pub const fn cycles_for(self, counts: u64) -> u64 {
        match self.counts {
            0 => NEVER,
            1 => counts * self.cycles,
            divisor => (counts * self.cycles).div_ceil(divisor),
        }
    }
}

/// A cycle that does not come.
pub const NEVER: u64 = u64::MAX;

/// A moment, and how fast the peripheral clock is then.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Now {
    pub(crate) cycle: u64,
    pub(crate) peripheral: Rate,
}

/// Counting that began at some moment and goes on through changes of its clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CountSpan {
    since: u64,
    /// Counts that were complete then.
    done: u64,
    rate: Rate,
}

impl CountSpan {
    pub(crate) fn new(cycle: u64, rate: Rate) -> CountSpan {
        CountSpan {
            since: cycle,
            done: 0,
            rate,
        }
    }

    /// The cycle at which so many counts are complete, or when the clock changed last if they were complete before.
    pub(crate) fn cycle_of(&self, counts: u64) -> u64 {
        match counts.saturating_sub(self.done) {
            0 => self.since,
            left => self.since.saturating_add(self.rate.cycles_for(left)),
        }
    }

    /// The clock is another one from this cycle on.
    pub(crate) fn change_rate(&mut self, cycle: u64, rate: Rate) {
        self.done += self.rate.counts_in(cycle.saturating_sub(self.since));
        (self.since, self.rate) = (cycle, rate);
    }
}

/// `value * factor / divisor`, without overflow between.
#[expect(
    clippy::cast_possible_truncation,
    reason = "years of machine time fit into 64 bits"
)]
const fn wide(value: u64, factor: u64, divisor: u64) -> u64 {
    (value as u128 * factor as u128 / divisor as u128) as u64
}

const fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_and_cycles_agree() {
        for hz in [80_000_000, 64_000_000, 8_000_000, 32_768, 32_000, 96_000_000] {
            let rate = Rate::from_hz(hz);
            assert_eq!(rate.hz(), hz);
            for counts in [1, 2, 3, 1000, 65_536] {
                let cycles = rate.cycles_for(counts);
                assert_eq!(rate.counts_in(cycles), counts, "{hz} Hz");
                assert_eq!(rate.counts_in(cycles - 1), counts - 1, "{hz} Hz");
            }
        }
    }

    #[test]
    fn what_stands_still_never_counts() {
        assert_eq!(Rate::from_hz(0).divided(8).counts_in(1 << 40), 0);
        assert_eq!(Rate::STOPPED.cycles_for(1), NEVER);
    }
}
