//! Levels and times from bytes. A timer interrupt comes at each *change* of level, not at each bit: a run of equal bits is
//! one wait.

use crate::baud::BitTime;
use crate::edge::Level;

/// What the timer interrupt does now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Due {
    /// Set the pin to this level, and come again after so many counts of the timer.
    Run {
        /// The level of the pin.
        level: Level,
        /// How long it holds, in counts: 1 to 65535, so that a timer of 16 bits will do.
        counts: u32,
    },
    /// Nothing more to send: the pin is high, stop the timer. Begin again with [`Transmitter::prepare`].
    Idle,
}

/// Sends bytes. In the interrupt of a timer:
///
/// ```
/// use soft_uart::{Baud, BitTime, ByteRing, Due, Level, Transmitter};
///
/// static BYTES: ByteRing<256> = ByteRing::new();
///
/// fn on_timer(transmitter: &mut Transmitter, pin: &mut Level, period_counts: &mut u32) {
///     // First the pin, at the same distance from the interrupt each time; then what takes longer.
///     match transmitter.due() {
///         Due::Run { level, counts } => {
///             *pin = level;
///             *period_counts = counts;
///             transmitter.prepare(|| BYTES.pop());
///         }
///         Due::Idle => *period_counts = 0,
///     }
/// }
///
/// let mut transmitter = Transmitter::new(BitTime::new(Baud::B230400, 80_000_000));
/// BYTES.push(b"U");
/// transmitter.prepare(|| BYTES.pop());
/// let (mut pin, mut period) = (Level::High, 0);
/// on_timer(&mut transmitter, &mut pin, &mut period);
/// assert_eq!((pin, period), (Level::Low, 347));
/// ```
///
/// To begin after [`Due::Idle`], call [`Self::prepare`] and start the timer with any short period.
#[derive(Clone, Debug)]
pub struct Transmitter {
    bit: BitTime,
    /// Most bits in one run.
    run_bits_max: u32,
    /// Bits not sent yet, next one lowest.
    frame: u32,
    /// How many of them.
    left: u32,
    /// Parts of a count that earlier runs left over.
    parts: u32,
    due: Due,
}

const FRAME_BITS: u32 = 10;
const STOP_BIT: u32 = 1 << 9;

impl Transmitter {
    /// A transmitter with nothing to send. `bit` is in counts of the timer whose interrupt drives it.
    #[must_use]
    pub const fn new(bit: BitTime) -> Self {
        Self {
            bit,
            run_bits_max: run_bits_max(bit),
            frame: 0,
            left: 0,
            parts: 0,
            due: Due::Idle,
        }
    }

    /// What to do now. Cheap: it was made ready by [`Self::prepare`].
    #[inline(always)]
    #[must_use]
    pub const fn due(&self) -> Due {
        self.due
    }

    /// Makes the next [`Self::due`] ready. `next_byte` is asked when the byte before has been handed out whole.
    #[inline]
    pub fn prepare(&mut self, next_byte: impl FnOnce() -> Option<u8>) {
        if self.left == 0 {
            let Some(byte) = next_byte() else {
                self.due = Due::Idle;
                return;
            };
            self.frame = STOP_BIT | (u32::from(byte) << 1);
            self.left = FRAME_BITS;
        }
        let level = Level::of_bit(self.frame);
        // Ones where the level is another one.
        let other = match level {
            Level::Low => self.frame,
            Level::High => !self.frame,
        };
        let equal = other.trailing_zeros().min(self.left).min(self.run_bits_max);
        self.frame >>= equal;
        self.left -= equal;
        let parts = equal * self.bit.parts().get() + self.parts;
        self.parts = parts & 0xFF;
        self.due = Due::Run {
            level,
            counts: parts >> 8,
        };
    }

    /// Changes the rate. Call it while nothing is sent; a byte under way would be torn.
    pub fn set_bit_time(&mut self, bit: BitTime) {
        self.bit = bit;
        self.run_bits_max = run_bits_max(bit);
        self.parts = 0;
    }
}

/// Bits whose counts, with what earlier runs left over, stay below 2^16.
const fn run_bits_max(bit: BitTime) -> u32 {
    let bits = 0x00FF_FF00 / bit.parts().get();
    if bits == 0 { 1 } else { bits }
}
