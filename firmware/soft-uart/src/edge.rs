//! The level of a line, and its changes.

/// The level of a line. High is idle, as on every UART without inversion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// 0 V: start bit, data bit 0.
    Low,
    /// Supply voltage: idle, stop bit, data bit 1.
    High,
}

impl Level {
    /// The other one.
    #[must_use]
    pub const fn inverted(self) -> Self {
        match self {
            Self::Low => Self::High,
            Self::High => Self::Low,
        }
    }

    /// High for a bit that is set.
    #[must_use]
    pub const fn of_bit(bit: u32) -> Self {
        if bit & 1 == 0 { Self::Low } else { Self::High }
    }

    pub(crate) const fn bit(self) -> u32 {
        match self {
            Self::Low => 0,
            Self::High => 1,
        }
    }
}

/// A change of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// When, in counts of a counter that wraps at 32 bits. Its lowest bit is not kept in an [`crate::EdgeRing`].
    pub at: u32,
    /// The level since then.
    pub level: Level,
}

impl Edge {
    /// One word: the level takes the place of the lowest bit of the time, so that an edge is stored in one access.
    #[must_use]
    pub const fn packed(self) -> u32 {
        (self.at & !1) | self.level.bit()
    }

    /// The reverse of [`Self::packed`], with an even time.
    #[must_use]
    pub const fn unpacked(word: u32) -> Self {
        Self {
            at: word & !1,
            level: Level::of_bit(word),
        }
    }
}
