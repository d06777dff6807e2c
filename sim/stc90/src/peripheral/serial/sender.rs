//! The transmitter.

use super::frame::SentFrame;
use super::rate::Rate;
use crate::peripheral::timer2::TICKS_PER_CYCLE;

/// What is to be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Outgoing {
    pub(super) byte: u8,
    pub(super) ninth: Option<bool>,
    pub(super) is_shifted: bool,
    pub(super) line_is_free: bool,
}

/// The transmitter with what it sends.
#[derive(Clone, Debug, Default)]
pub(super) struct Sender {
    /// Waits for a rate.
    waiting: Option<Outgoing>,
    /// What is on the line, and the tick at which TI is set.
    sending: Option<(u64, SentFrame)>,
    sent: Vec<SentFrame>,
}

impl Sender {
    /// Whether a byte written now cuts off one that is being sent.
    pub(super) fn is_busy(&self) -> bool {
        self.waiting.is_some() || self.sending.is_some()
    }

    /// SBUF was written.
    pub(super) fn send(&mut self, outgoing: Outgoing, rate: &Rate, cycle: u64) {
        self.sending = None;
        self.waiting = Some(outgoing);
        self.begin(rate, cycle);
    }

    /// Begins what waits, when there is a rate.
    pub(super) fn begin(&mut self, rate: &Rate, cycle: u64) {
        let Some(outgoing) = self.waiting else {
            return;
        };
        let tick = cycle * TICKS_PER_CYCLE;
        let shifted = outgoing
            .is_shifted
            .then_some((tick + TICKS_PER_CYCLE, TICKS_PER_CYCLE));
        let Some((start, bit_ticks)) = shifted.or_else(|| rate.next_rollover(tick)) else {
            return;
        };
        self.waiting = None;
        // TI comes with the begin of the stop bit; the shift register has neither start nor stop bit.
        let bits = match (outgoing.is_shifted, outgoing.ninth) {
            (true, _) => 8,
            (false, None) => 9,
            (false, Some(_)) => 10,
        };
        let frame = SentFrame {
            cycle: start.div_ceil(TICKS_PER_CYCLE),
            bit_ticks,
            byte: outgoing.byte,
            ninth: outgoing.ninth,
            line_is_free: outgoing.line_is_free,
        };
        self.sending = Some((start + bits * bit_ticks, frame));
    }

    /// The cycle in which it sets TI.
    pub(super) fn next(&self) -> u64 {
        self.sending
            .map_or(u64::MAX, |(tick, _)| tick.div_ceil(TICKS_PER_CYCLE))
    }

    /// Says whether TI is set by now.
    pub(super) fn advance(&mut self, cycle: u64) -> bool {
        let ended = self.next() <= cycle;
        if ended {
            self.sent.extend(self.sending.take().map(|(_, frame)| frame));
        }
        ended
    }

    /// What was sent up to its stop bit since the last call.
    pub(super) fn take(&mut self) -> Vec<SentFrame> {
        std::mem::take(&mut self.sent)
    }

    /// A reset cuts off what is being sent.
    pub(super) fn reset(&mut self) {
        self.waiting = None;
        self.sending = None;
    }
}
