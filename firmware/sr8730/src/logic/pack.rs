//! Voltages and charge current of the battery pack from the counts of the converter.
//!
//! One count is 32.5 mV at the pack and, over the shunt of 0.3 ohm, 108 mA. Two dividers made of 1 % resistors may differ by
//! half an ampere's worth, so the zero of the current matters. It is learnt while nothing can flow: the shunt lies
//! in the charge path only, so without a supply on the contacts there is no current. On the dock it is never learnt, or a
//! switch that is stuck closed would pass for the zero.

/// Scans from which the zero is learnt: about half a second.
const ZERO_SCANS: u32 = 512;
/// Largest zero that dividers of 1 % can make, in counts; more is a fault that must be seen as current.
const ZERO_MAX_COUNTS: i32 = 20;
/// Shunt in tenths of an ohm.
const SHUNT_TENTHS_OHM: i64 = 3;

/// One look at the pack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PackReading {
    /// Voltage behind the shunt: the pack.
    pub pack_mv: i32,
    /// Voltage before the shunt: the charger's side.
    pub input_mv: i32,
    /// Current into the pack, zero taken off.
    pub current_ma: i32,
}

/// Turns counts into quantities.
#[derive(Clone, Copy, Debug)]
pub struct PackMeter {
    scale_uv: i64,
    /// Difference of the counts without current, times [`ZERO_SCANS`].
    zero: i32,
    sum: i32,
    scans: u32,
}

impl PackMeter {
    /// With the voltage of one count at the pack in microvolts, and the zero of the current in hundredths of a count, both from
    /// the calibration.
    #[must_use]
    pub const fn new(scale_uv: i32, zero_centicounts: i32) -> Self {
        Self {
            scale_uv: scale_uv as i64,
            zero: zero_centicounts.saturating_mul(ZERO_SCANS as i32) / 100,
            sum: 0,
            scans: 0,
        }
    }

    /// Takes one scan for learning. `supplied` = a supply is on the contacts.
    pub fn learn(&mut self, before: u16, after: u16, supplied: bool) {
        if supplied {
            self.sum = 0;
            self.scans = 0;
            return;
        }
        self.sum += i32::from(before) - i32::from(after);
        self.scans += 1;
        if self.scans >= ZERO_SCANS {
            if self.sum.abs() <= ZERO_MAX_COUNTS * ZERO_SCANS as i32 {
                self.zero = self.sum;
            }
            self.sum = 0;
            self.scans = 0;
        }
    }

    /// What one scan says: counts before and behind the shunt, ten bits each.
    #[must_use]
    pub fn reading(&self, before: u16, after: u16) -> PackReading {
        let scans = i64::from(ZERO_SCANS);
        let drop = (i64::from(before) - i64::from(after)) * scans - i64::from(self.zero);
        // Counts below 1,024 and a scale below 50,000: everything stays below 2^31.
        PackReading {
            pack_mv: (i64::from(after) * self.scale_uv / 1_000) as i32,
            input_mv: (i64::from(before) * self.scale_uv / 1_000) as i32,
            current_ma: (drop * self.scale_uv * 10 / (SHUNT_TENTHS_OHM * scans * 1_000)) as i32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{PackMeter, PackReading};

    /// 3.3 V / 1024 x 10.1.
    const SCALE_UV: i32 = 32_549;

    fn taught(scans: usize, before: u16, after: u16, supplied: bool) -> PackMeter {
        let mut meter = PackMeter::new(SCALE_UV, 0);
        for _ in 0..scans {
            meter.learn(before, after, supplied);
        }
        meter
    }

    #[test]
    fn one_count_is_32_millivolts_and_108_milliamperes() {
        let reading = PackMeter::new(SCALE_UV, 0).reading(492, 491);
        assert_eq!(
            reading,
            PackReading {
                pack_mv: 15_981,
                input_mv: 16_014,
                current_ma: 108
            }
        );
    }

    #[test]
    fn the_zero_is_learnt_without_a_supply_only() {
        assert_eq!(taught(2_000, 497, 492, true).reading(497, 492).current_ma, 542);
        assert_eq!(taught(511, 497, 492, false).reading(497, 492).current_ma, 542);
        let meter = taught(512, 497, 492, false);
        assert_eq!(meter.reading(497, 492).current_ma, 0);
        assert_eq!(meter.reading(507, 492).current_ma, 1_084);
    }

    #[test]
    fn half_a_count_of_zero_is_learnt_from_the_mean() {
        let mut meter = PackMeter::new(SCALE_UV, 0);
        for scan in 0..512 {
            meter.learn(492 + scan % 2, 492, false);
        }
        assert_eq!(meter.reading(493, 492).current_ma, 54);
    }

    #[test]
    fn a_supply_in_between_starts_the_learning_anew() {
        let mut meter = taught(500, 500, 492, false);
        meter.learn(520, 492, true);
        for _ in 0..500 {
            meter.learn(500, 492, false);
        }
        assert_eq!(meter.reading(500, 492).current_ma, 867);
    }

    #[test]
    fn a_zero_that_no_divider_makes_is_not_learnt() {
        assert_eq!(taught(2_000, 513, 492, false).reading(513, 492).current_ma, 2_278);
        assert_eq!(
            taught(2_000, 471, 492, false).reading(471, 492).current_ma,
            -2_278
        );
    }

    #[test]
    fn a_measured_zero_holds_from_the_start() {
        assert_eq!(PackMeter::new(SCALE_UV, 350).reading(496, 492).current_ma, 54);
        assert_eq!(PackMeter::new(SCALE_UV, -100).reading(492, 492).current_ma, 108);
    }

    #[test]
    fn full_scale_does_not_overflow() {
        let reading = PackMeter::new(45_000, -2_000).reading(1_023, 0);
        assert_eq!((reading.input_mv, reading.current_ma), (46_035, 156_450));
    }
}
