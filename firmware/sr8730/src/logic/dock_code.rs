//! The code that requests full current from the dock: 33 bits on a 38 kHz carrier.
//!
//! An interrupt at 76 kHz sets the emitter's line for one half period of the carrier. A bit lasts 0.5 ms, 19 periods of
//! the carrier; a 1 is carrier, the highest bit comes first (see `robots/samsung-sr8730/dock-signal.md`).

/// The code of the original's source, which worked on a robot: six leading ones.
const CODE_SIX_ONES: u64 = 0x1_F8C3_0CC3;
/// Bits of the code with six leading ones.
const BITS_SIX_ONES: u8 = 33;
/// CarrierHalf periods of the carrier in one bit.
const HALVES_PER_BIT: u8 = 38;

/// Time from one start of the code to the next.
pub const REPEAT_MS: u32 = 200;
/// Counts of Timer1 in one half period: 80 MHz / 76 kHz.
pub const HALF_PERIOD_COUNTS: u16 = 1_053;

/// Number of leading ones: the original's source has six, the author's thesis prints five.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LeadingOnes {
    /// As in the thesis.
    Five,
    /// As in the source.
    #[default]
    Six,
}

impl LeadingOnes {
    /// From the calibration value; six when it is not known.
    #[must_use]
    pub const fn from_calibration(value: Option<i32>) -> Self {
        match value {
            Some(5) => Self::Five,
            _ => Self::Six,
        }
    }
}

/// Position in one transmission of the code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DockCode {
    rest: u64,
    bits: u8,
    halves: u8,
}

/// Level of the emitter's line for a half period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CarrierHalf {
    /// High: the emitter is lit.
    High,
    /// Low.
    Low,
    /// The code is over; the line is low.
    Over,
}

impl DockCode {
    /// Nothing to send.
    pub const IDLE: Self = Self {
        rest: 0,
        bits: 0,
        halves: 0,
    };

    /// At the start of the code.
    #[must_use]
    pub const fn start(ones: LeadingOnes) -> Self {
        let bits = match ones {
            LeadingOnes::Six => BITS_SIX_ONES,
            LeadingOnes::Five => BITS_SIX_ONES - 1,
        };
        // The first bit to send is the highest of the word; a missing leading one is shifted out.
        Self {
            rest: CODE_SIX_ONES << (u64::BITS - bits as u32),
            bits,
            halves: 0,
        }
    }

    /// The next half period.
    #[inline]
    pub const fn next(&mut self) -> CarrierHalf {
        if self.bits == 0 {
            return CarrierHalf::Over;
        }
        let carrier = self.rest >> 63 == 1 && self.halves & 1 == 0;
        self.halves += 1;
        if self.halves == HALVES_PER_BIT {
            self.halves = 0;
            self.bits -= 1;
            self.rest <<= 1;
        }
        if carrier {
            CarrierHalf::High
        } else {
            CarrierHalf::Low
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{CarrierHalf, DockCode, HALF_PERIOD_COUNTS, HALVES_PER_BIT, LeadingOnes};
    use std::string::String;
    use std::vec::Vec;

    fn halves(ones: LeadingOnes) -> Vec<CarrierHalf> {
        let mut code = DockCode::start(ones);
        core::iter::from_fn(|| Some(code.next()).filter(|half| *half != CarrierHalf::Over)).collect()
    }

    /// One digit a bit, whose half periods must all agree.
    fn digits(halves: &[CarrierHalf]) -> String {
        halves
            .chunks(usize::from(HALVES_PER_BIT))
            .map(|bit| {
                let carrier = bit.first() == Some(&CarrierHalf::High);
                for pair in bit.chunks(2) {
                    assert_eq!(
                        pair,
                        [
                            if carrier {
                                CarrierHalf::High
                            } else {
                                CarrierHalf::Low
                            },
                            CarrierHalf::Low
                        ]
                    );
                }
                if carrier { '1' } else { '0' }
            })
            .collect()
    }

    #[test]
    fn six_ones_are_the_code_of_the_source() {
        let sent = halves(LeadingOnes::Six);
        assert_eq!(sent.len(), 33 * 38);
        assert_eq!(digits(&sent), "111111000110000110000110011000011");
    }

    #[test]
    fn five_ones_are_the_code_of_the_thesis() {
        assert_eq!(
            digits(&halves(LeadingOnes::Five)),
            "11111000110000110000110011000011"
        );
        assert_eq!(LeadingOnes::from_calibration(Some(5)), LeadingOnes::Five);
        assert_eq!(LeadingOnes::from_calibration(None), LeadingOnes::Six);
    }

    #[test]
    fn the_carrier_is_38_khz_and_a_bit_half_a_millisecond() {
        let carrier_hz = 80e6 / f64::from(HALF_PERIOD_COUNTS) / 2.0;
        assert!((carrier_hz - 38_000.0).abs() < 20.0, "{carrier_hz}");
        let bit_ms = f64::from(HALVES_PER_BIT) * f64::from(HALF_PERIOD_COUNTS) / 80e3;
        assert!((bit_ms - 0.5).abs() < 0.001, "{bit_ms}");
    }
}
