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
    /// Bits not sent yet, next one lowest, and above the stop bit [`END`].
    frame: u32,
    /// Parts of a count that earlier runs left over.
    parts: u32,
    /// Counts of the run that is due, 0 when none is.
    counts: u32,
    level: Level,
}

/// What stands above the last bit: a zero, which ends the run of the stop bit, and a one, which is always there.
const END: u32 = 0b10;
const FRAME_BITS: u32 = 10;
const STOP_BIT: u32 = 1 << 9;

impl Transmitter {
    /// A transmitter with nothing to send. `bit` is in counts of the timer whose interrupt drives it.
    #[must_use]
    pub const fn new(bit: BitTime) -> Self {
        Self {
            bit,
            run_bits_max: run_bits_max(bit),
            frame: END,
            parts: 0,
            counts: 0,
            level: Level::High,
        }
    }

    /// What to do now. Cheap: it was made ready by [`Self::prepare`].
    #[inline(always)]
    #[must_use]
    pub const fn due(&self) -> Due {
        match self.counts {
            0 => Due::Idle,
            counts => Due::Run {
                level: self.level,
                counts,
            },
        }
    }

    /// Makes the next [`Self::due`] ready. `next_byte` is asked when the byte before has been handed out whole.
    #[inline]
    pub fn prepare(&mut self, next_byte: impl FnOnce() -> Option<u8>) {
        let mut frame = self.frame;
        if frame == END {
            let Some(byte) = next_byte() else {
                self.counts = 0;
                return;
            };
            frame = (END << FRAME_BITS) | STOP_BIT | (u32::from(byte) << 1);
        }
        self.level = Level::of_bit(frame);
        // All ones for a high level: then the ones are where the level is another one.
        let same = (frame & 1).wrapping_neg();
        let equal = (frame ^ same).trailing_zeros().min(self.run_bits_max);
        self.frame = frame >> equal;
        // At most ten bits of 2^24 parts, and 255.
        let parts = equal
            .wrapping_mul(self.bit.parts().get())
            .wrapping_add(self.parts);
        self.parts = parts & 0xFF;
        self.counts = parts >> 8;
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
