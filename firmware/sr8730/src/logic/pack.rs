//! Voltages and charge current of the battery pack from single scans of the converter.
//!
//! One count is 32.5 mV at the pack and, over the shunt of 0.3 ohm, 108 mA: only means of many scans say anything, and a
//! mean over whole envelopes of the charger (20 ms) sees the pulses and their pauses in their true proportion. Two dividers
//! of 1 % resistors may differ by half an ampere's worth; that zero is learnt while nothing can flow, which is certain only
//! without a supply on the contacts.

/// Scans in one envelope of the charger.
const BLOCK_SCANS: u16 = 20;
/// Envelopes in a mean: 100 ms, which is what stopping on over-current may take.
const BLOCKS: usize = 5;
/// Blocks without a supply from which the zero is learnt: 0.64 s.
const ZERO_BLOCKS: u8 = 32;
/// Shunt in tenths of an ohm.
const SHUNT_TENTHS_OHM: i64 = 3;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Block {
    before: u32,
    after: u32,
}

/// Means of the newest scans.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PackMeans {
    /// Voltage behind the shunt: the pack.
    pub pack_mv: i32,
    /// Voltage before the shunt: the charger's side.
    pub input_mv: i32,
    /// Current into the pack, zero taken off.
    pub current_ma: i32,
}

/// Collects scans.
#[derive(Clone, Copy, Debug)]
pub struct PackMeter {
    scale_uv: i64,
    blocks: [Block; BLOCKS],
    filled: u8,
    next: u8,
    partial: Block,
    scans: u16,
    zero: ZeroPoint,
}

/// The difference of the two dividers when no current flows, in counts summed over [`BLOCKS`] blocks.
#[derive(Clone, Copy, Debug, Default)]
struct ZeroPoint {
    learnt: Option<i32>,
    sum: i32,
    blocks: u8,
}

impl PackMeter {
    /// Nothing measured yet; `scale_uv` is microvolts at the pack for one count.
    #[must_use]
    pub const fn new(scale_uv: i32) -> Self {
        Self {
            scale_uv: scale_uv as i64,
            blocks: [Block { before: 0, after: 0 }; BLOCKS],
            filled: 0,
            next: 0,
            partial: Block { before: 0, after: 0 },
            scans: 0,
            zero: ZeroPoint {
                learnt: None,
                sum: 0,
                blocks: 0,
            },
        }
    }

    /// Takes one scan: readings before and behind the shunt. `supplied` = a supply is on the contacts.
    pub fn push(&mut self, before: u16, after: u16, supplied: bool) {
        self.partial.before += u32::from(before);
        self.partial.after += u32::from(after);
        self.scans += 1;
        if supplied {
            self.zero.sum = 0;
            self.zero.blocks = 0;
        }
        if self.scans < BLOCK_SCANS {
            return;
        }
        let block = core::mem::take(&mut self.partial);
        self.scans = 0;
        if let Some(place) = self.blocks.get_mut(usize::from(self.next)) {
            *place = block;
        }
        self.next = (self.next + 1) % BLOCKS as u8;
        self.filled = (self.filled + 1).min(BLOCKS as u8);
        if !supplied {
            self.zero.learn(block);
        }
    }

    /// Means over the newest 100 ms, or `None` until that much was measured.
    #[must_use]
    pub fn means(&self) -> Option<PackMeans> {
        if usize::from(self.filled) < BLOCKS {
            return None;
        }
        let before: u32 = self.blocks.iter().map(|block| block.before).sum();
        let after: u32 = self.blocks.iter().map(|block| block.after).sum();
        let scans = i64::from(BLOCK_SCANS) * BLOCKS as i64;
        let millivolts = |sum: i64| saturate(sum * self.scale_uv / scans / 1_000);
        let drop = i64::from(before) - i64::from(after) - i64::from(self.zero.learnt.unwrap_or(0));
        Some(PackMeans {
            pack_mv: millivolts(i64::from(after)),
            input_mv: millivolts(i64::from(before)),
            current_ma: saturate(drop * self.scale_uv * 10 / SHUNT_TENTHS_OHM / scans / 1_000),
        })
    }

    /// Whether the zero of the current is known.
    #[must_use]
    pub const fn has_zero(&self) -> bool {
        self.zero.learnt.is_some()
    }
}

impl ZeroPoint {
    fn learn(&mut self, block: Block) {
        // A block sums 20 readings of at most 1023.
        self.sum += block.before as i32 - block.after as i32;
        self.blocks += 1;
        if self.blocks >= ZERO_BLOCKS {
            self.learnt = Some(self.sum * BLOCKS as i32 / i32::from(ZERO_BLOCKS));
            self.sum = 0;
            self.blocks = 0;
        }
    }
}

fn saturate(value: i64) -> i32 {
    i32::try_from(value).unwrap_or(if value < 0 { i32::MIN } else { i32::MAX })
}

#[cfg(test)]
mod tests {
    use super::{PackMeans, PackMeter};

    /// 3.3 V / 1024 x 10.1.
    const SCALE_UV: i32 = 32_549;

    fn fed(scans: usize, before: u16, after: u16, supplied: bool) -> PackMeter {
        let mut meter = PackMeter::new(SCALE_UV);
        feed(&mut meter, scans, (before, after), supplied);
        meter
    }

    fn feed(meter: &mut PackMeter, scans: usize, readings: (u16, u16), supplied: bool) {
        for _ in 0..scans {
            meter.push(readings.0, readings.1, supplied);
        }
    }

    #[test]
    fn nothing_is_said_before_a_hundred_milliseconds_were_measured() {
        assert_eq!(fed(99, 500, 500, true).means(), None);
        assert!(fed(100, 500, 500, true).means().is_some());
    }

    #[test]
    fn one_count_of_difference_is_108_milliamperes() {
        let means = fed(100, 492, 491, true).means().unwrap();
        assert_eq!(
            means,
            PackMeans {
                pack_mv: 15_981,
                input_mv: 16_014,
                current_ma: 108
            }
        );
    }

    #[test]
    fn the_zero_is_learnt_without_a_supply_only() {
        let mut meter = fed(2_000, 497, 492, true);
        assert!(!meter.has_zero());
        feed(&mut meter, 640, (497, 492), false);
        assert!(meter.has_zero());
        assert_eq!(meter.means().unwrap().current_ma, 0);
        feed(&mut meter, 100, (507, 492), true);
        assert_eq!(meter.means().unwrap().current_ma, 1_084);
    }

    #[test]
    fn a_supply_in_between_starts_the_learning_anew() {
        let mut meter = fed(600, 500, 492, false);
        feed(&mut meter, 20, (520, 492), true);
        feed(&mut meter, 600, (500, 492), false);
        assert!(!meter.has_zero());
    }

    #[test]
    fn a_mean_over_an_envelope_sees_pulses_in_their_proportion() {
        let mut meter = PackMeter::new(SCALE_UV);
        for scan in 0..100 {
            let before = if scan % 20 < 15 { 504 } else { 492 };
            meter.push(before, 492, true);
        }
        assert_eq!(meter.means().unwrap().current_ma, 976);
    }

    #[test]
    fn full_scale_does_not_overflow() {
        let means = fed(200, 1023, 0, true).means().unwrap();
        assert_eq!(means.input_mv, 33_297);
        assert_eq!(means.current_ma, 110_992);
    }
}
