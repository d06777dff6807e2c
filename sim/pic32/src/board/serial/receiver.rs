//! A UART's receiver that samples a pin.

use rvac_channel::ReceivedByte;

use super::FRAME_BITS;
use crate::pins::Level;

/// A receiver for 8N1 that starts with a falling edge and samples each bit in its middle. After a wrong stop bit it
/// waits for a high line.
#[derive(Clone, Debug)]
pub struct BitReceiver {
    bit_cycles: f64,
    line: Level,
    state: ReceiverState,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum ReceiverState {
    Idle,
    /// The start bit began at `start`; `taken` bits were sampled into `bits`, the first in the lowest place.
    Frame {
        start: f64,
        taken: u32,
        bits: u16,
    },
    WaitForHigh,
}

/// What was received, and the cycle in which the receiver knew it.
pub(super) type TimedByte = (u64, ReceivedByte);

impl BitReceiver {
    /// A receiver on an idle line.
    #[must_use]
    pub const fn new(bit_cycles: f64) -> Self {
        Self {
            bit_cycles,
            line: Level::High,
            state: ReceiverState::Idle,
        }
    }

    /// The line changes to `level` at `cycle`, which is not before earlier ones.
    pub fn edge(&mut self, cycle: u64, level: Level, arrivals: &mut Vec<TimedByte>) {
        self.advance(cycle, arrivals);
        let falls = self.line.is_high() && !level.is_high();
        self.line = level;
        match self.state {
            ReceiverState::Idle if falls => {
                self.state = ReceiverState::Frame {
                    start: cycle as f64,
                    taken: 0,
                    bits: 0,
                };
            }
            ReceiverState::WaitForHigh if level.is_high() => self.state = ReceiverState::Idle,
            ReceiverState::Idle | ReceiverState::Frame { .. } | ReceiverState::WaitForHigh => {}
        }
    }

    /// Time passes up to `cycle`, which it does not include.
    pub fn advance(&mut self, cycle: u64, arrivals: &mut Vec<TimedByte>) {
        while let ReceiverState::Frame { start, taken, bits } = self.state {
            let sampled = start + (f64::from(taken) + 0.5) * self.bit_cycles;
            if sampled >= cycle as f64 {
                return;
            }
            let bits = bits | u16::from(self.line.is_high()) << taken;
            self.state = if taken == 0 && self.line.is_high() {
                // The start bit was shorter than half a bit: noise.
                ReceiverState::Idle
            } else if taken + 1 < FRAME_BITS {
                ReceiverState::Frame {
                    start,
                    taken: taken + 1,
                    bits,
                }
            } else if self.line.is_high() {
                arrivals.push((sampled as u64, ReceivedByte::Byte((bits >> 1) as u8)));
                ReceiverState::Idle
            } else {
                arrivals.push((sampled as u64, ReceivedByte::FramingError));
                ReceiverState::WaitForHigh
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{BitReceiver, Level, ReceivedByte, TimedByte};

    const BIT: f64 = 347.2;

    /// Sends bytes with bits of `bit` cycles and one stop bit to a receiver for bits of [`BIT`].
    fn receive(bytes: &[u8], bit: f64) -> Vec<ReceivedByte> {
        let mut receiver = BitReceiver::new(BIT);
        let mut arrivals: Vec<TimedByte> = Vec::new();
        let mut at = 1000.0;
        for byte in bytes {
            let levels = u16::from(*byte) << 1 | 1 << 9;
            for place in 0..10 {
                let level = Level::of(levels >> place & 1 == 1);
                receiver.edge((at + f64::from(place) * bit) as u64, level, &mut arrivals);
            }
            at += 10.0 * bit;
        }
        receiver.advance(at as u64, &mut arrivals);
        arrivals.into_iter().map(|(_, received)| received).collect()
    }

    #[test]
    fn every_byte_arrives_back_to_back_at_rates_within_four_percent() {
        let bytes: Vec<u8> = (0..=255).collect();
        let wanted: Vec<_> = bytes.iter().copied().map(ReceivedByte::Byte).collect();
        for factor in [0.96, 0.98, 1.0, 1.02, 1.04] {
            assert_eq!(receive(&bytes, BIT * factor), wanted, "at {factor} of the rate");
        }
        assert_ne!(receive(&bytes, BIT * 0.9), wanted);
    }

    #[test]
    fn a_low_line_is_one_framing_error() {
        let mut receiver = BitReceiver::new(BIT);
        let mut arrivals = Vec::new();
        receiver.edge(1000, Level::Low, &mut arrivals);
        receiver.advance(1_000_000, &mut arrivals);
        receiver.edge(1_000_000, Level::High, &mut arrivals);
        receiver.advance(2_000_000, &mut arrivals);
        assert_eq!(arrivals.len(), 1);
        assert_eq!(arrivals[0].1, ReceivedByte::FramingError);
    }

    #[test]
    fn a_spike_is_no_start_bit() {
        let mut receiver = BitReceiver::new(BIT);
        let mut arrivals = Vec::new();
        receiver.edge(1000, Level::Low, &mut arrivals);
        receiver.edge(1100, Level::High, &mut arrivals);
        receiver.advance(10_000, &mut arrivals);
        assert_eq!(arrivals, []);
    }
}
