//! A line with faults.

use std::collections::VecDeque;

use crate::random::Pcg32;
use crate::uart::{ReceivedByte, UartReceiver, line_bits};

/// How often what goes wrong. All are probabilities, 0 = never.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultRates {
    /// Per bit on the line, start and stop bits included: the level is inverted.
    pub bit_error: f64,
    /// Per byte: the byte never reaches the line.
    pub lost_byte: f64,
    /// Per byte: the byte is sent twice.
    pub doubled_byte: f64,
    /// Per byte: the line stays high for 1 to [`run_bytes_max`](Self::run_bytes_max) bytes, which are lost.
    pub cut_out: f64,
    /// Per byte: each bit of the next 1 to `run_bytes_max` bytes is inverted with probability 1/2.
    pub burst: f64,
    /// Per byte: this and what follows is held back for 1 to `run_bytes_max` byte times and then comes at once.
    pub delay: f64,
    /// Per byte: the receiver's hardware drops the byte and reports an overrun.
    pub overrun: f64,
    /// Longest cut-out, burst and delay in bytes; 0 is taken for 1.
    pub run_bytes_max: u32,
}

impl FaultRates {
    /// A perfect line.
    pub const NONE: Self = Self {
        bit_error: 0.0,
        lost_byte: 0.0,
        doubled_byte: 0.0,
        cut_out: 0.0,
        burst: 0.0,
        delay: 0.0,
        overrun: 0.0,
        run_bytes_max: 32,
    };
}

/// One direction of a serial line.
#[derive(Clone, Debug)]
pub struct Channel {
    rates: FaultRates,
    random: Pcg32,
    receiver: UartReceiver,
    bits_to_flip: u64,
    cut_out_left: u32,
    burst_left: u32,
    delay_left: u32,
    delayed: VecDeque<ReceivedByte>,
}

const LINE_BITS: u64 = 10;

impl Channel {
    /// A line whose faults follow from `seed`.
    #[must_use]
    pub fn new(seed: u64, rates: FaultRates) -> Self {
        let mut random = Pcg32::new(seed);
        let bits_to_flip = random.misses_before_hit(rates.bit_error);
        Self {
            rates,
            random,
            receiver: UartReceiver::default(),
            bits_to_flip,
            cut_out_left: 0,
            burst_left: 0,
            delay_left: 0,
            delayed: VecDeque::new(),
        }
    }

    /// Changes the rates; runs that have begun go on.
    pub fn set_rates(&mut self, rates: FaultRates) {
        self.rates = rates;
        self.bits_to_flip = self.random.misses_before_hit(rates.bit_error);
    }

    /// Sends one byte; what the receiver reports meanwhile is appended to `received`.
    pub fn pass(&mut self, byte: u8, received: &mut Vec<ReceivedByte>) {
        self.draw_runs();
        if self.cut_out_left > 0 {
            self.cut_out_left -= 1;
            self.idle(received);
            return;
        }
        if self.random.happens(self.rates.lost_byte) {
            self.idle(received);
            return;
        }
        self.send(line_bits(byte), received);
        if self.random.happens(self.rates.doubled_byte) {
            self.send(line_bits(byte), received);
        }
    }

    /// What the line carries instead of this byte (`None` = it rests): frames of ten levels, bit 0 first, for receivers
    /// that look at levels themselves. A delay is a rest before the byte. Overruns are of receivers and do not happen.
    pub fn carry(&mut self, byte: Option<u8>, frames: &mut Vec<u16>) {
        self.draw_runs();
        for _ in 0..core::mem::take(&mut self.delay_left) {
            frames.push(u16::MAX ^ self.draw_flips());
        }
        let lost = self.random.happens(self.rates.lost_byte);
        let levels = match byte {
            Some(byte) if !lost && self.cut_out_left == 0 => line_bits(byte),
            _ => u16::MAX,
        };
        self.cut_out_left = self.cut_out_left.saturating_sub(1);
        frames.push(levels ^ self.draw_flips());
        if byte.is_some() && self.random.happens(self.rates.doubled_byte) {
            frames.push(levels ^ self.draw_flips());
        }
    }

    /// Lets the line rest for the time of one byte.
    pub fn idle(&mut self, received: &mut Vec<ReceivedByte>) {
        self.send(u16::MAX, received);
    }

    fn draw_runs(&mut self) {
        if self.random.happens(self.rates.cut_out) {
            self.cut_out_left = self.draw_run();
        }
        if self.random.happens(self.rates.burst) {
            self.burst_left = self.draw_run();
        }
        if self.random.happens(self.rates.delay) {
            self.delay_left = self.draw_run();
        }
    }

    fn draw_run(&mut self) -> u32 {
        1 + self.random.below(self.rates.run_bytes_max)
    }

    fn send(&mut self, levels: u16, received: &mut Vec<ReceivedByte>) {
        let flips = self.draw_flips();
        if flips == 0 && self.receiver.is_idle() {
            self.send_whole(levels, received);
            return;
        }
        let damaged = levels ^ flips;
        for bit in 0..LINE_BITS {
            if let Some(reported) = self.receiver.bit(damaged >> bit & 1 == 1) {
                self.deliver(reported, received);
            }
        }
        self.let_go_delayed(received);
    }

    /// An undamaged byte that finds the receiver waiting needs no bits.
    fn send_whole(&mut self, levels: u16, received: &mut Vec<ReceivedByte>) {
        if levels & 1 == 0 {
            self.deliver(ReceivedByte::Byte((levels >> 1) as u8), received);
        }
        self.let_go_delayed(received);
    }

    fn let_go_delayed(&mut self, received: &mut Vec<ReceivedByte>) {
        if self.delay_left > 0 {
            self.delay_left -= 1;
        } else {
            received.extend(self.delayed.drain(..));
        }
    }

    fn draw_flips(&mut self) -> u16 {
        let mut flips = 0;
        while self.bits_to_flip < LINE_BITS {
            flips |= 1 << self.bits_to_flip;
            let gap = self.random.misses_before_hit(self.rates.bit_error);
            self.bits_to_flip = self.bits_to_flip.saturating_add(1).saturating_add(gap);
        }
        self.bits_to_flip = self.bits_to_flip.saturating_sub(LINE_BITS);
        if self.burst_left > 0 {
            self.burst_left -= 1;
            flips ^= self.random.next_u32() as u16;
        }
        flips
    }

    fn deliver(&mut self, reported: ReceivedByte, received: &mut Vec<ReceivedByte>) {
        let reported = if self.random.happens(self.rates.overrun) {
            ReceivedByte::Overrun
        } else {
            reported
        };
        if self.delay_left > 0 || !self.delayed.is_empty() {
            self.delayed.push_back(reported);
        } else {
            received.push(reported);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Channel, FaultRates};
    use crate::uart::ReceivedByte;

    fn pass_all(channel: &mut Channel, bytes: &[u8]) -> Vec<ReceivedByte> {
        let mut received = Vec::new();
        for byte in bytes {
            channel.pass(*byte, &mut received);
        }
        for _ in 0..64 {
            channel.idle(&mut received);
        }
        received
    }

    fn text() -> Vec<u8> {
        (0..20_000_u32).map(|index| (index * 7) as u8).collect()
    }

    #[test]
    fn a_perfect_line_changes_nothing() {
        let sent = text();
        let received = pass_all(&mut Channel::new(1, FaultRates::NONE), &sent);
        assert!(received.into_iter().eq(sent.into_iter().map(ReceivedByte::Byte)));
    }

    #[test]
    fn the_same_seed_does_the_same_damage() {
        let rates = FaultRates {
            bit_error: 1e-3,
            lost_byte: 1e-3,
            doubled_byte: 1e-3,
            cut_out: 1e-3,
            burst: 1e-3,
            delay: 1e-3,
            overrun: 1e-3,
            run_bytes_max: 16,
        };
        let run = |seed| pass_all(&mut Channel::new(seed, rates), &text());
        assert_eq!(run(3), run(3));
        assert_ne!(run(3), run(4));
    }

    #[test]
    fn rates_are_what_they_say() {
        let lost = FaultRates {
            lost_byte: 0.1,
            ..FaultRates::NONE
        };
        let received = pass_all(&mut Channel::new(5, lost), &text()).len();
        assert!(
            (17_700..18_300).contains(&received),
            "{received} of 20,000 arrived"
        );
        let flips = FaultRates {
            bit_error: 1e-3,
            ..FaultRates::NONE
        };
        let errors = pass_all(&mut Channel::new(6, flips), &text())
            .into_iter()
            .filter(|byte| *byte == ReceivedByte::FramingError)
            .count();
        assert!(errors > 10, "{errors} framing errors");
    }

    #[test]
    fn levels_are_damaged_like_bytes() {
        let carried = |rates| {
            let mut channel = Channel::new(8, rates);
            let mut frames = Vec::new();
            for byte in text() {
                channel.carry(Some(byte), &mut frames);
            }
            frames
        };
        let whole = carried(FaultRates::NONE);
        assert!(whole.iter().copied().eq(text().into_iter().map(super::line_bits)));
        let flips = carried(FaultRates {
            bit_error: 1e-3,
            ..FaultRates::NONE
        });
        let flipped: u32 = flips.iter().zip(&whole).map(|(a, b)| (a ^ b).count_ones()).sum();
        assert!((150..250).contains(&flipped), "{flipped} of 200,000 bits");
        let delays = carried(FaultRates {
            delay: 0.01,
            ..FaultRates::NONE
        });
        assert!(delays.len() > whole.len());
        assert!(delays.into_iter().filter(|frame| *frame != u16::MAX).eq(whole));
    }

    #[test]
    fn a_delay_loses_nothing_and_keeps_the_order() {
        let delays = FaultRates {
            delay: 0.01,
            ..FaultRates::NONE
        };
        let sent = text();
        let received = pass_all(&mut Channel::new(7, delays), &sent);
        assert!(received.into_iter().eq(sent.into_iter().map(ReceivedByte::Byte)));
    }
}
