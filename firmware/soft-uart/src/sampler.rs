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
enum Phase {
    Idle,
    AwaitHigh,
    Frame(Frame),
}

/// The bit at `position` is read after `wait` more samples; `bits` holds those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Frame {
    wait: u8,
    position: u8,
    bits: u16,
}

/// Decodes samples taken at three times the bit rate. Small enough for the interrupt that takes them.
#[derive(Clone, Debug)]
pub struct Sampler {
    phase: Phase,
}

impl Sampler {
    /// Samples in a bit.
    pub const SAMPLES_PER_BIT: u32 = SAMPLES as u32;

    /// A sampler on an idle line.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            phase: Phase::AwaitHigh,
        }
    }

    /// Takes the next sample; gives what ended with it.
    #[inline]
    pub fn sample(&mut self, level: Level) -> Option<Received> {
        match (self.phase, level) {
            (Phase::Idle, Level::Low) => {
                self.phase = Phase::Frame(Frame {
                    wait: 0,
                    position: 0,
                    bits: 0,
                });
                None
            }
            (Phase::AwaitHigh, Level::High) => {
                self.phase = Phase::Idle;
                None
            }
            (Phase::Idle | Phase::AwaitHigh, _) => None,
            (Phase::Frame(frame), level) => self.in_frame(level, frame),
        }
    }

    fn in_frame(&mut self, level: Level, frame: Frame) -> Option<Received> {
        let Frame { wait, position, bits } = frame;
        if let Some(wait) = wait.checked_sub(1) {
            self.phase = Phase::Frame(Frame { wait, ..frame });
            return None;
        }
        if position == STOP {
            return Some(self.end(level, (bits >> 1) as u8));
        }
        let bits = bits | ((level.bit() as u16) << position);
        self.phase = if position == 0 && level == Level::High {
            // A low that does not last to the middle of the start bit is noise.
            Phase::Idle
        } else {
            Phase::Frame(Frame {
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
                self.phase = Phase::Idle;
                Received::Byte(data)
            }
            Level::Low => {
                self.phase = Phase::AwaitHigh;
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
