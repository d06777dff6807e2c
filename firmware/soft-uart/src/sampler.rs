//! Bytes from samples, for a pin that cannot report its changes: a timer reads it at three times the bit rate.
//!
//! The start edge lies up to one sample before the sample that sees it, so the sample after that one lies between 0.33
//! and 0.67 of the bit, and so do those three, six .. samples later: the middle of each bit within a sixth of a bit. A
//! difference of the clocks of 3.5 % is borne.

use crate::decoder::Received;
use crate::edge::Level;

/// Samples a bit.
const SAMPLES: u8 = 3;
/// The stop bit's position.
const STOP: u8 = 9;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SamplerPhase {
    Idle,
    AwaitHigh,
    Frame(SampledFrame),
}

/// The bit at `position` is read after `wait` more samples; `bits` holds those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct SampledFrame {
    wait: u8,
    position: u8,
    bits: u16,
}

/// Decodes samples taken at three times the bit rate. Small enough for the interrupt that takes them.
#[derive(Clone, Debug)]
pub struct Sampler {
    phase: SamplerPhase,
}

impl Sampler {
    /// Samples in a bit.
    pub const SAMPLES_PER_BIT: u32 = SAMPLES as u32;

    /// A sampler on an idle line.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            phase: SamplerPhase::AwaitHigh,
        }
    }

    /// Takes the next sample; gives what ended with it.
    #[inline]
    pub fn sample(&mut self, level: Level) -> Option<Received> {
        match (self.phase, level) {
            (SamplerPhase::Idle, Level::Low) => {
                self.phase = SamplerPhase::Frame(SampledFrame {
                    wait: 0,
                    position: 0,
                    bits: 0,
                });
                None
            }
            (SamplerPhase::AwaitHigh, Level::High) => {
                self.phase = SamplerPhase::Idle;
                None
            }
            (SamplerPhase::Idle | SamplerPhase::AwaitHigh, _) => None,
            (SamplerPhase::Frame(frame), level) => self.in_frame(level, frame),
        }
    }

    fn in_frame(&mut self, level: Level, frame: SampledFrame) -> Option<Received> {
        let SampledFrame { wait, position, bits } = frame;
        if let Some(wait) = wait.checked_sub(1) {
            self.phase = SamplerPhase::Frame(SampledFrame { wait, ..frame });
            return None;
        }
        if position == STOP {
            return Some(self.end(level, (bits >> 1) as u8));
        }
        let bits = bits | ((level.bit() as u16) << position);
        self.phase = if position == 0 && level == Level::High {
            // A low that does not last to the middle of the start bit is noise.
            SamplerPhase::Idle
        } else {
            SamplerPhase::Frame(SampledFrame {
                wait: SAMPLES - 1,
                position: position + 1,
                bits,
            })
        };
        None
    }

    fn end(&mut self, stop: Level, data: u8) -> Received {
        match stop {
            Level::High => {
                self.phase = SamplerPhase::Idle;
                Received::Byte(data)
            }
            Level::Low => {
                self.phase = SamplerPhase::AwaitHigh;
                if data == 0 {
                    Received::Break
                } else {
                    Received::FramingError
                }
            }
        }
    }
}

impl Default for Sampler {
    fn default() -> Self {
        Self::new()
    }
}
