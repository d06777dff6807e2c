//! The receiver.

use super::frame::LineFrame;
use super::rate::Rate;
use crate::peripheral::timer2::TICKS_PER_CYCLE;
use std::collections::VecDeque;

/// What the receiver makes of the levels that it sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Received {
    pub(super) byte: u8,
    /// The ninth data bit, or the stop bit where there is none.
    pub(super) ninth: bool,
    pub(super) stop: bool,
}

/// How many data bits a mode has, and whether the program lets the receiver listen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Listening {
    Off,
    Bits(u8),
}

/// The receiver with what is on the line.
///
/// It samples each bit in its middle, by its own rate, from the falling edge of the start bit on. A sender with another
/// rate is therefore misread as it would be on a wire.
#[derive(Clone, Debug, Default)]
pub(super) struct Receiver {
    line: VecDeque<LineFrame>,
    /// What it will have received, and at which tick.
    hearing: Option<(u64, Received)>,
    unheard: u64,
}

impl Receiver {
    /// A frame that begins now or later, after all that were told before.
    pub(super) fn hear(&mut self, frame: LineFrame) {
        self.line.push_back(frame);
    }

    /// The cycle in which something happens.
    pub(super) fn next(&self) -> u64 {
        let start = self.line.front().map_or(u64::MAX, |frame| frame.cycle);
        let end = self
            .hearing
            .map_or(u64::MAX, |(tick, _)| tick.div_ceil(TICKS_PER_CYCLE));
        start.min(end)
    }

    /// Goes on to `cycle`, and says what was received by then.
    pub(super) fn advance(&mut self, cycle: u64, rate: &Rate, listening: Listening) -> Option<Received> {
        let ended = self
            .hearing
            .filter(|(tick, _)| tick.div_ceil(TICKS_PER_CYCLE) <= cycle);
        if ended.is_some() {
            self.hearing = None;
        }
        while let Some(frame) = self.line.front().copied().filter(|frame| frame.cycle <= cycle) {
            self.line.pop_front();
            self.begin(&frame, rate, listening);
        }
        ended.map(|(_, received)| received)
    }

    fn begin(&mut self, frame: &LineFrame, rate: &Rate, listening: Listening) {
        let (Listening::Bits(data_bits), Some(bit), None) = (listening, rate.bit(), self.hearing) else {
            self.unheard += 1;
            return;
        };
        let sample = |number: u64| frame.is_high_at(number * bit + bit / 2);
        if sample(0) {
            self.unheard += 1;
            return;
        }
        let byte = (0..8).fold(0, |byte, number| byte | u8::from(sample(number + 1)) << number);
        let stop_place = u64::from(data_bits) + 1;
        let received = Received {
            byte,
            ninth: sample(9),
            stop: sample(stop_place),
        };
        // The third of the three samples in the middle of the stop bit decides.
        let end = frame.cycle * TICKS_PER_CYCLE + stop_place * bit + bit * 9 / 16;
        self.hearing = Some((end, received));
    }

    /// Frames that begin before `cycle` pass unheard.
    pub(super) fn skip_to(&mut self, cycle: u64) {
        let passed = self.line.iter().take_while(|frame| frame.cycle < cycle).count();
        self.line.drain(..passed);
        self.unheard += passed as u64;
    }

    /// Frames that passed while it could not listen.
    pub(super) fn unheard(&self) -> u64 {
        self.unheard
    }

    /// A reset ends what it hears; the line stays as it is.
    pub(super) fn reset(&mut self) {
        self.hearing = None;
    }
}
