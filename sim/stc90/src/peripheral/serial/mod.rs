//! The UART: a byte at a time with framing error, ninth bit and recognition of its own address.
//!
//! The circuit hands over and takes frames with their times, not edges. The receiver has one buffer: a byte that is
//! complete while RI is still set is lost, as on the chip, and counted.

mod frame;
mod rate;
mod receiver;
mod sender;

pub use frame::{LineFrame, SentFrame};

use super::register::{SMOD, SMOD0};
use super::timer2::TICKS_PER_CYCLE;
use rate::Rate;
use receiver::{Listening, Received, Receiver};
use sender::{Outgoing, Sender};

const SM0: u8 = 0x80;
const SM1: u8 = 0x40;
const SM2: u8 = 0x20;
const REN: u8 = 0x10;
const TB8: u8 = 0x08;
const RB8: u8 = 0x04;
const TI: u8 = 0x02;
const RI: u8 = 0x01;

/// Cycles that the shift register needs for a byte that it takes in.
const SHIFT_CYCLES: u64 = 9;

/// Where the rate comes from. A period is the time between two overflows in ticks, nothing when it stands still.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Clocks {
    /// Timer 1.
    pub(super) timer_1: Option<u64>,
    /// Timer 2 for the transmitter, if it is chosen.
    pub(super) transmit: Option<Option<u64>>,
    /// Timer 2 for the receiver, if it is chosen.
    pub(super) receive: Option<Option<u64>>,
    /// PCON.
    pub(super) pcon: u8,
}

/// The UART with its registers.
#[derive(Clone, Debug, Default)]
pub(super) struct Serial {
    scon: u8,
    has_framing_error: bool,
    buffer: u8,
    pub(super) address: u8,
    pub(super) address_mask: u8,
    transmit_rate: Rate,
    receive_rate: Rate,
    sender: Sender,
    receiver: Receiver,
    /// End of a byte that the shift register takes in.
    shift_ends: Option<u64>,
    overruns: u64,
    /// Level of P3.0, for the shift register.
    pub(super) line_is_high: bool,
}

impl Serial {
    /// A reset: the line goes on, the chip forgets.
    pub(super) fn reset(&mut self) {
        let mut sender = std::mem::take(&mut self.sender);
        let mut receiver = std::mem::take(&mut self.receiver);
        sender.reset();
        receiver.reset();
        *self = Self {
            sender,
            receiver,
            overruns: self.overruns,
            line_is_high: self.line_is_high,
            ..Self::default()
        };
    }

    /// The clock stops in the midst of whatever is on the line.
    pub(super) fn reset_line(&mut self) {
        self.sender.reset();
        self.receiver.reset();
        self.shift_ends = None;
    }

    /// Time passed in which the chip had no clock, and so no ears.
    pub(super) fn skip_to(&mut self, cycle: u64) {
        self.receiver.skip_to(cycle);
    }

    fn is_shift_register(&self) -> bool {
        self.scon & (SM0 | SM1) == 0
    }

    fn has_ninth(&self) -> bool {
        self.scon & SM0 != 0
    }

    /// Takes over rates that may have changed.
    pub(super) fn set_clocks(&mut self, clocks: &Clocks, cycle: u64) {
        let tick = cycle * TICKS_PER_CYCLE;
        let doubled = clocks.pcon & SMOD != 0;
        let halved = if doubled { 1 } else { 2 };
        let of_timers = |timer_2: Option<Option<u64>>| match timer_2 {
            Some(period) => period.map(|period| 16 * period),
            None => clocks.timer_1.map(|period| 16 * halved * period),
        };
        // Mode 2 divides the clock itself: 32 or 64 of the clocks of which a machine cycle has twelve.
        let (transmit, receive) = if self.scon & (SM0 | SM1) == SM0 {
            (Some(16 * halved), Some(16 * halved))
        } else {
            (of_timers(clocks.transmit), of_timers(clocks.receive))
        };
        self.transmit_rate.set(transmit, tick);
        self.receive_rate.set(receive, tick);
        self.sender.begin(&self.transmit_rate, cycle);
    }

    /// Ticks of a bit as the receiver counts them.
    pub(super) fn receive_bit(&self) -> Option<u64> {
        self.receive_rate.bit()
    }

    /// Goes on to `cycle`.
    pub(super) fn advance(&mut self, cycle: u64) {
        if self.sender.advance(cycle) {
            self.scon |= TI;
        }
        if self.shift_ends.is_some_and(|end| end <= cycle) {
            self.shift_ends = None;
            self.buffer = if self.line_is_high { 0xFF } else { 0 };
            self.scon |= RI;
        }
        let listening = match (self.scon & REN != 0, self.is_shift_register()) {
            (true, false) => Listening::Bits(if self.has_ninth() { 9 } else { 8 }),
            _ => Listening::Off,
        };
        if let Some(received) = self.receiver.advance(cycle, &self.receive_rate, listening) {
            self.take(received);
        }
    }

    fn take(&mut self, received: Received) {
        if self.scon & RI != 0 {
            self.overruns += 1;
            return;
        }
        if self.scon & SM2 != 0 && !(received.ninth && self.is_meant(received.byte)) {
            return;
        }
        self.buffer = received.byte;
        self.scon = self.scon & !RB8 | RI | if received.ninth { RB8 } else { 0 };
        self.has_framing_error |= !received.stop;
    }

    /// Whether a byte is the address of this chip or that of all. With both registers at zero every byte is.
    fn is_meant(&self, byte: u8) -> bool {
        let all = self.address | self.address_mask;
        let is_own = (byte ^ self.address) & self.address_mask == 0;
        is_own || byte & all == all
    }

    /// The cycle in which something happens.
    pub(super) fn next(&self) -> u64 {
        let shift = self.shift_ends.unwrap_or(u64::MAX);
        self.sender.next().min(self.receiver.next()).min(shift)
    }

    /// Whether it asks for an interrupt.
    pub(super) fn requests(&self) -> bool {
        self.scon & (TI | RI) != 0
    }

    /// SCON.
    pub(super) fn control(&self, pcon: u8) -> u8 {
        if pcon & SMOD0 == 0 {
            return self.scon;
        }
        self.scon & !SM0 | if self.has_framing_error { SM0 } else { 0 }
    }

    pub(super) fn set_control(&mut self, value: u8, pcon: u8, cycle: u64) {
        if pcon & SMOD0 == 0 {
            self.scon = value;
        } else {
            self.scon = self.scon & SM0 | value & !SM0;
            self.has_framing_error = value & SM0 != 0;
        }
        let shifts_in = self.is_shift_register() && self.scon & (REN | RI) == REN;
        self.shift_ends = shifts_in.then(|| self.shift_ends.unwrap_or(cycle + SHIFT_CYCLES));
    }

    /// SBUF, as it is read.
    pub(super) fn buffer(&self) -> u8 {
        self.buffer
    }

    /// SBUF is written. Says whether that cuts off a byte that is being sent.
    pub(super) fn send(&mut self, byte: u8, line_is_free: bool, cycle: u64) -> bool {
        let cuts_off = self.sender.is_busy();
        let outgoing = Outgoing {
            byte,
            ninth: self.has_ninth().then_some(self.scon & TB8 != 0),
            is_shifted: self.is_shift_register(),
            line_is_free,
        };
        self.sender.send(outgoing, &self.transmit_rate, cycle);
        cuts_off
    }

    /// A frame comes along the line.
    pub(super) fn hear(&mut self, frame: LineFrame) {
        self.receiver.hear(frame);
    }

    /// What was sent since the last call.
    pub(super) fn take_sent(&mut self) -> Vec<SentFrame> {
        self.sender.take()
    }

    /// Bytes that were lost because the program had not taken the one before.
    pub(super) fn overruns(&self) -> u64 {
        self.overruns
    }

    /// Frames that passed while the receiver could not listen.
    pub(super) fn unheard(&self) -> u64 {
        self.receiver.unheard()
    }
}
