//! Bytes on the line, with the times at which they begin.

use crate::peripheral::timer2::TICKS_PER_CYCLE;

/// Levels of a frame that the chip is to hear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineFrame {
    /// Machine cycle in which the start bit begins.
    pub cycle: u64,
    /// How long a bit takes, in sixths of a machine cycle.
    pub bit_ticks: u64,
    /// Levels one bit long, the start bit lowest; what follows the sixteenth is high.
    levels: u16,
}

impl LineFrame {
    /// A start bit, eight data bits and a stop bit.
    #[must_use]
    pub const fn byte(cycle: u64, bit_ticks: u64, byte: u8) -> Self {
        Self {
            cycle,
            bit_ticks,
            levels: 0xFE00 | (byte as u16) << 1,
        }
    }

    /// The same with a ninth data bit.
    #[must_use]
    pub const fn nine_bits(cycle: u64, bit_ticks: u64, data: u16) -> Self {
        Self {
            cycle,
            bit_ticks,
            levels: 0xFC00 | (data & 0x1FF) << 1,
        }
    }

    /// Ten levels from this cycle on, as a damaged line may carry them; nothing when all of them are high. The frame begins
    /// with the first low one.
    #[must_use]
    pub const fn of_levels(cycle: u64, bit_ticks: u64, levels: u16) -> Option<Self> {
        let levels = levels | 0xFC00;
        let high = levels.trailing_ones();
        if high >= 16 {
            return None;
        }
        let begin = cycle + high as u64 * bit_ticks / TICKS_PER_CYCLE;
        let levels = !(!levels >> high);
        Some(Self {
            cycle: begin,
            bit_ticks,
            levels,
        })
    }

    /// The line goes low for sixteen bits.
    #[must_use]
    pub const fn long_break(cycle: u64, bit_ticks: u64) -> Self {
        Self {
            cycle,
            bit_ticks,
            levels: 0,
        }
    }

    /// The same byte with a low level where its stop bit should be, one bit long.
    #[must_use]
    pub const fn with_framing_error(self) -> Self {
        Self {
            levels: self.levels & !0x0200,
            ..self
        }
    }

    /// Whether the line is high, this many ticks after the start.
    pub(super) fn is_high_at(&self, ticks: u64) -> bool {
        let bit = ticks.checked_div(self.bit_ticks).unwrap_or(u64::MAX);
        bit >= 16 || self.levels >> bit & 1 != 0
    }
}

/// A frame that the chip sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SentFrame {
    /// Machine cycle in which its start bit begins.
    pub cycle: u64,
    /// How long a bit takes, in sixths of a machine cycle.
    pub bit_ticks: u64,
    /// Its eight data bits.
    pub byte: u8,
    /// The ninth data bit in modes that have one.
    pub ninth: Option<bool>,
    /// Whether the latch of P3.1 let it out. At 0 it holds the line low, and nobody hears a thing.
    pub line_is_free: bool,
}
