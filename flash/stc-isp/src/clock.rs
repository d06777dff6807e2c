//! The chip's clock, which the loader measures, and the rates that follow from it.

/// Rate of the handshake.
pub const HANDSHAKE_BAUD: u32 = 2_400;
/// Rates for the data, fastest first.
pub const RATES_BAUD: [u32; 5] = [115_200, 57_600, 38_400, 19_200, 9_600];
/// A rate that is off by more than this is not used, in parts per thousand.
const ERROR_PERMILLE_MAX: u64 = 30;
/// Crystals of these chips, with room for an error of measurement.
const PLAUSIBLE_HZ: std::ops::RangeInclusive<u64> = 1_000_000..=50_000_000;

/// What is known of the chip's clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChipClock {
    /// Crystal, hertz.
    pub hz: u64,
    /// Clocks of a machine cycle, 6 or 12.
    pub clocks_per_cycle: u32,
}

/// A rate that the chip can make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RateSetting {
    pub(crate) baud: u32,
    /// Reload value of timer 2.
    pub(crate) reload: u16,
}

impl ChipClock {
    /// From the counters of the status: the chip counted seven bits of 0x7F in its own cycles. None for a clock that no such chip has.
    pub(crate) fn of_counters(counters: &[u16], clocks_per_cycle: u32) -> Option<Self> {
        let count = counters.len() as u64;
        let sum: u64 = counters.iter().map(|counter| u64::from(*counter)).sum();
        let hz = (sum * u64::from(HANDSHAKE_BAUD) * u64::from(clocks_per_cycle)).checked_div(7 * count)?;
        PLAUSIBLE_HZ
            .contains(&hz)
            .then_some(Self { hz, clocks_per_cycle })
    }

    /// Rates that the chip can make well enough, fastest first.
    pub(crate) fn rates(self) -> impl Iterator<Item = RateSetting> {
        // Timer 2 divides by 16 in 6T mode and by 32 in 12T mode.
        let divider = u64::from(self.clocks_per_cycle) / 6 * 16;
        RATES_BAUD.into_iter().filter_map(move |baud| {
            let counts = (self.hz + divider * u64::from(baud) / 2) / (divider * u64::from(baud));
            let reload = u16::try_from(0x1_0000_u64.checked_sub(counts)?).ok()?;
            let made = self.hz.checked_div(divider * counts)?;
            let off = made.abs_diff(u64::from(baud)) * 1_000 / u64::from(baud);
            (off <= ERROR_PERMILLE_MAX).then_some(RateSetting { baud, reload })
        })
    }

    /// Waiting states for flash: 0 at 20 MHz and above.
    pub(crate) fn flash_wait(self) -> u8 {
        match self.hz {
            20_000_000.. => 0,
            10_000_000.. => 1,
            5_000_000.. => 2,
            _ => 3,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ChipClock, RateSetting};

    #[test]
    fn the_relax_makes_the_rates_of_the_reference() {
        let clock = ChipClock {
            hz: 30_000_000,
            clocks_per_cycle: 6,
        };
        let rates: Vec<RateSetting> = clock.rates().collect();
        let reloads: Vec<(u32, u16)> = rates.iter().map(|rate| (rate.baud, rate.reload)).collect();
        assert_eq!(
            reloads[..3],
            [(115_200, 0xFFF0), (57_600, 0xFFDF), (38_400, 0xFFCF)]
        );
        let slow = ChipClock {
            clocks_per_cycle: 12,
            ..clock
        };
        assert_eq!(slow.rates().next().map(|rate| rate.reload), Some(0xFFF8));
        assert_eq!(clock.flash_wait(), 0);
    }

    #[test]
    fn a_clock_comes_from_the_counters() {
        let clock = ChipClock::of_counters(&[14_583; 8], 6).expect("plausible");
        assert!(clock.hz.abs_diff(30_000_000) < 30_000, "{clock:?}");
        assert_eq!(ChipClock::of_counters(&[0; 8], 6), None);
        assert_eq!(ChipClock::of_counters(&[0xFFFF; 8], 12), None);
        assert_eq!(ChipClock::of_counters(&[], 12), None);
    }
}
