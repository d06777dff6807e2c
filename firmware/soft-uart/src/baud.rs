//! Bit rates, and how long a bit lasts in counts of a timer.

use core::num::NonZeroU32;

/// Parts of a count in which a bit time is kept. 256 parts of a count of 40 MHz leave an error below 0.0002 bits over a
/// frame at 230400 baud.
const PARTS: u64 = 256;

/// A rate that is in use between machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Baud {
    /// 9600 bits a second.
    B9600,
    /// 19200 bits a second.
    B19200,
    /// 38400 bits a second.
    B38400,
    /// 57600 bits a second.
    B57600,
    /// 115200 bits a second.
    B115200,
    /// 230400 bits a second.
    B230400,
}

impl Baud {
    /// All rates, slowest first.
    pub const ALL: [Self; 6] = [
        Self::B9600,
        Self::B19200,
        Self::B38400,
        Self::B57600,
        Self::B115200,
        Self::B230400,
    ];

    /// Bits a second.
    #[must_use]
    pub const fn bits_per_second(self) -> u32 {
        match self {
            Self::B9600 => 9_600,
            Self::B19200 => 19_200,
            Self::B38400 => 38_400,
            Self::B57600 => 57_600,
            Self::B115200 => 115_200,
            Self::B230400 => 230_400,
        }
    }

    /// The rate of exactly so many bits a second, or `None` when it is not in the list.
    #[must_use]
    pub fn from_bits_per_second(bits_per_second: u32) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|baud| baud.bits_per_second() == bits_per_second)
    }
}

/// How long a bit lasts, in counts of a timer and parts of 256 of a count. Never zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitTime(NonZeroU32);

impl BitTime {
    /// A bit at `baud` on a timer of `counts_per_second`, which should be at least ten times the rate and at most
    /// 100 MHz. Outside of that the result saturates: such a timer cannot serve this rate.
    #[must_use]
    pub const fn new(baud: Baud, counts_per_second: u32) -> Self {
        let rate = baud.bits_per_second() as u64;
        let parts = (counts_per_second as u64 * PARTS + rate / 2) / rate;
        let parts = if parts > u32::MAX as u64 >> 8 {
            u32::MAX >> 8
        } else {
            parts as u32
        };
        match NonZeroU32::new(parts) {
            Some(parts) => Self(parts),
            None => Self(NonZeroU32::MIN),
        }
    }

    /// In parts of 256 of a count.
    #[must_use]
    pub const fn parts(self) -> NonZeroU32 {
        self.0
    }

    /// Whole counts, rounded.
    #[must_use]
    pub const fn counts(self) -> u32 {
        (self.0.get() + 128) >> 8
    }
}
