//! Voltages and charge current of the battery pack from the counts of the converter.
//!
//! One count is 32.5 mV at the pack and, over the shunt of 0.3 ohm, 108 mA. Two dividers made of 1 % resistors may
//! differ by the equivalent of half an ampere. This offset is a calibration value, and cordlib learns the remainder off
//! the dock, where no current can flow, because the shunt lies in the charge path only.

/// Shunt in tenths of an ohm.
const SHUNT_TENTHS_OHM: i64 = 3;

/// One reading of the pack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PackReading {
    /// Voltage behind the shunt: the pack.
    pub pack_mv: i32,
    /// Voltage before the shunt: the charger's side.
    pub input_mv: i32,
    /// Current into the pack, offset subtracted.
    pub current_ma: i32,
}

/// Converts counts to quantities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PackScale {
    scale_uv: i64,
    zero_centicounts: i64,
}

impl PackScale {
    /// With the voltage of one count at the pack in microvolts, and the zero of the current in hundredths of a count,
    /// both from the calibration.
    #[must_use]
    pub const fn new(scale_uv: i32, zero_centicounts: i32) -> Self {
        Self {
            scale_uv: scale_uv as i64,
            zero_centicounts: zero_centicounts as i64,
        }
    }

    /// Reading of one scan: counts before and behind the shunt, ten bits each.
    #[must_use]
    pub fn reading(&self, before: u16, after: u16) -> PackReading {
        let drop = (i64::from(before) - i64::from(after)) * 100 - self.zero_centicounts;
        // Counts below 1,024 and a scale below 50,000: everything stays below 2^31.
        PackReading {
            pack_mv: (i64::from(after) * self.scale_uv / 1_000) as i32,
            input_mv: (i64::from(before) * self.scale_uv / 1_000) as i32,
            current_ma: (drop * self.scale_uv / (SHUNT_TENTHS_OHM * 10_000)) as i32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{PackReading, PackScale};

    /// 3.3 V / 1024 x 10.1.
    const SCALE_UV: i32 = 32_549;

    #[test]
    fn one_count_is_32_millivolts_and_108_milliamperes() {
        let reading = PackScale::new(SCALE_UV, 0).reading(492, 491);
        let expected = PackReading {
            pack_mv: 15_981,
            input_mv: 16_014,
            current_ma: 108,
        };
        assert_eq!(reading, expected);
    }

    #[test]
    fn a_measured_zero_is_taken_off() {
        assert_eq!(PackScale::new(SCALE_UV, 350).reading(496, 492).current_ma, 54);
        assert_eq!(PackScale::new(SCALE_UV, -100).reading(492, 492).current_ma, 108);
    }

    #[test]
    fn full_scale_does_not_overflow() {
        let reading = PackScale::new(45_000, -2_000).reading(1_023, 0);
        assert_eq!((reading.input_mv, reading.current_ma), (46_035, 156_450));
    }
}
