//! UART 1 and 2 (here 0 and 1): queues, bit times, framing, both as levels on their pins.

use super::buses::BusEvents;
use super::rate::{CountSpan, NEVER, Now};
use crate::pins::{Level, Pin, Port, known};
use std::collections::VecDeque;

/// U1TX and U2TX.
pub(crate) const TRANSMIT_PINS: [Pin; 2] = [known(Port::F, 3), known(Port::F, 5)];
/// U1RX and U2RX.
pub(crate) const RECEIVE_PINS: [Pin; 2] = [known(Port::F, 2), known(Port::F, 4)];

const ON: u32 = 1 << 15;
const LOOPBACK: u32 = 1 << 6;
const RECEIVE_INVERTED: u32 = 1 << 4;
const FAST: u32 = 1 << 3;
const TWO_STOP_BITS: u32 = 1 << 0;
/// UEN, IREN, WAKE, ABAUD: not modelled.
const MODE_OPTIONS: u32 = 0x13A0;
const MODE_WRITABLE: u32 = 0xFBFF;

const TRANSMIT_INVERTED: u32 = 1 << 13;
const RECEIVE_ENABLED: u32 = 1 << 12;
const BREAK: u32 = 1 << 11;
const TRANSMIT_ENABLED: u32 = 1 << 10;
const FULL: u32 = 1 << 9;
const EMPTY: u32 = 1 << 8;
const ADDRESSES: u32 = 1 << 5;
const IDLE: u32 = 1 << 4;
const PARITY: u32 = 1 << 3;
const FRAMING: u32 = 1 << 2;
const OVERRUN: u32 = 1 << 1;
const AVAILABLE: u32 = 1 << 0;
const STATUS_WRITABLE: u32 = 0xFCE0;

/// Sources disagree whether queues hold 4 or 8 on this part.
const DEPTH: usize = 4;

/// What a UART has sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sent {
    /// A character of 8 or 9 bits.
    Character(u16),
    /// A break: the line was low for longer than a character.
    Break,
}

/// A frame on its way out.
#[derive(Clone, Copy, Debug)]
struct Shift {
    /// Counts clocks of the peripheral bus.
    span: CountSpan,
    bit_clocks: u64,
    /// Levels of its bits, the start bit in bit 0.
    levels: u16,
    /// How many bits.
    length: u8,
    /// The bit that is on the line.
    bit: u8,
    sent: Sent,
}

impl Shift {
    fn level(&self) -> bool {
        self.levels >> self.bit & 1 != 0
    }

    /// The bit at which the level changes next, or the end.
    fn next_change(&self) -> u8 {
        let same = |bit: &u8| (self.levels >> bit & 1 != 0) == self.level();
        (self.bit..self.length)
            .find(|bit| !same(bit))
            .unwrap_or(self.length)
    }

    fn cycle_of(&self, bit: u8) -> u64 {
        self.span.cycle_of(u64::from(bit) * self.bit_clocks)
    }
}

/// A frame on its way in.
#[derive(Clone, Debug)]
struct IncomingFrame {
    /// Counts clocks of the peripheral bus.
    span: CountSpan,
    bit_clocks: u64,
    edges: Vec<(u64, bool)>,
    confirmed: bool,
}

impl IncomingFrame {
    /// Middle of a bit, 0 for the start bit.
    fn middle(&self, bit: u64) -> u64 {
        self.span.cycle_of((2 * bit + 1) * self.bit_clocks / 2)
    }

    fn level_at(&self, cycle: u64) -> bool {
        self.edges
            .iter()
            .rev()
            .find(|edge| edge.0 <= cycle)
            .is_some_and(|edge| edge.1)
    }
}

#[derive(Clone, Copy, Debug)]
struct ReceivedFrame {
    character: u16,
    framing: bool,
    parity: bool,
}

/// One UART.
#[derive(Clone, Debug)]
pub(crate) struct Serial {
    mode: u32,
    status: u32,
    divider: u32,
    outgoing: VecDeque<u16>,
    shift: Option<Shift>,
    pub(crate) sent: Vec<(u64, Sent)>,
    pub(super) events: BusEvents,
    incoming: VecDeque<ReceivedFrame>,
    arrival: Option<IncomingFrame>,
    line: bool,
    overrun: bool,
}

/// Which interrupt lines are asserted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Lines {
    pub(crate) error: bool,
    pub(crate) receive: bool,
    pub(crate) transmit: bool,
}

impl Serial {
    pub(crate) fn new() -> Serial {
        Serial {
            mode: 0,
            status: 0,
            divider: 0,
            outgoing: VecDeque::new(),
            shift: None,
            sent: Vec::new(),
            events: BusEvents::default(),
            incoming: VecDeque::new(),
            arrival: None,
            line: true,
            overrun: false,
        }
    }

    /// After a reset: what was sent stays for whoever takes it.
    pub(crate) fn reset(&mut self) {
        let sent = std::mem::take(&mut self.sent);
        *self = Serial {
            sent,
            ..Serial::new()
        };
    }

    fn is_on(&self) -> bool {
        self.mode & ON != 0
    }

    fn transmits(&self) -> bool {
        self.is_on() && self.status & TRANSMIT_ENABLED != 0
    }

    fn receives(&self) -> bool {
        self.is_on() && self.status & RECEIVE_ENABLED != 0
    }

    /// Whether options are on that are not modelled.
    pub(crate) fn has_options(&self) -> bool {
        self.is_on() && (self.mode & MODE_OPTIONS != 0 || self.status & ADDRESSES != 0)
    }

    pub(crate) fn loops_back(&self) -> bool {
        self.mode & LOOPBACK != 0
    }

    /// What the UART does to its transmit pin; `None` when it leaves it alone.
    pub(crate) fn transmit_level(&self) -> Option<Level> {
        let high = self.shift.is_none_or(|shift| shift.level());
        self.transmits()
            .then(|| Level::of(high != (self.status & TRANSMIT_INVERTED != 0)))
    }

    /// Whether the receive pin is held as an input.
    pub(crate) fn holds_receive_pin(&self) -> bool {
        self.is_on()
    }

    /// Clocks of the peripheral bus that a bit takes.
    fn bit_clocks(&self) -> u64 {
        let clocks = if self.mode & FAST != 0 { 4 } else { 16 };
        clocks * (u64::from(self.divider) + 1)
    }

    /// The peripheral clock is another one from now on.
    pub(crate) fn change_clock(&mut self, now: Now) {
        let spans = self.shift.iter_mut().map(|shift| &mut shift.span);
        for span in spans.chain(self.arrival.iter_mut().map(|arrival| &mut arrival.span)) {
            span.change_rate(now.cycle, now.peripheral);
        }
    }

    /// Data bits and whether there is a parity bit.
    fn shape(&self) -> (u8, Option<bool>) {
        match self.mode >> 1 & 3 {
            0 => (8, None),
            1 => (8, Some(false)),
            2 => (8, Some(true)),
            _ => (9, None),
        }
    }

    pub(crate) fn next_transmit_event(&self) -> u64 {
        self.shift
            .map_or(NEVER, |shift| shift.cycle_of(shift.next_change()))
    }

    /// The next bit is on the line, or the frame is over.
    pub(crate) fn transmit(&mut self, now: Now) {
        let Some(shift) = &mut self.shift else { return };
        shift.bit = shift.next_change();
        if shift.bit < shift.length {
            return;
        }
        self.sent.push((now.cycle, shift.sent));
        self.shift = None;
        self.begin_frame(now);
    }

    fn begin_frame(&mut self, now: Now) {
        if self.shift.is_some() || !self.transmits() {
            return;
        }
        let Some(character) = self.outgoing.pop_front() else {
            return;
        };
        self.events.left = true;
        let (bits, parity) = self.shape();
        let stop_bits = if self.mode & TWO_STOP_BITS != 0 { 2 } else { 1 };
        let data = character & ((1 << bits) - 1);
        let mut levels = data << 1;
        let mut length = bits + 1;
        if let Some(odd) = parity {
            let ones = data.count_ones() % 2 == 1;
            levels |= u16::from(ones != odd) << length;
            length += 1;
        }
        levels |= 0x7FFF << length;
        let mut sent = Sent::Character(data);
        length += stop_bits;
        if self.status & BREAK != 0 {
            // A start bit, twelve zeros and a stop bit.
            (levels, length, sent) = (1 << 13, 14, Sent::Break);
            self.status &= !BREAK;
        }
        let bit_clocks = self.bit_clocks();
        self.shift = Some(Shift {
            span: CountSpan::new(now.cycle, now.peripheral),
            bit_clocks,
            levels,
            length,
            bit: 0,
            sent,
        });
    }

    pub(crate) fn next_receive_event(&self) -> u64 {
        match &self.arrival {
            None => NEVER,
            Some(arrival) if !arrival.confirmed => arrival.middle(0),
            Some(arrival) => arrival.middle(self.stop_bit()),
        }
    }

    fn stop_bit(&self) -> u64 {
        let (bits, parity) = self.shape();
        u64::from(bits) + 1 + u64::from(parity.is_some())
    }

    /// The level of the receive pin is another one.
    pub(crate) fn edge(&mut self, level: Level, now: Now) {
        let high = level.is_high() != (self.mode & RECEIVE_INVERTED != 0);
        if high == self.line {
            return;
        }
        self.line = high;
        let begins = !high && self.receives();
        match &mut self.arrival {
            Some(arrival) => arrival.edges.push((now.cycle, high)),
            None if begins => {
                let bit_clocks = self.bit_clocks();
                self.arrival = Some(IncomingFrame {
                    span: CountSpan::new(now.cycle, now.peripheral),
                    bit_clocks,
                    edges: vec![(now.cycle, false)],
                    confirmed: false,
                });
            }
            None => {}
        }
    }

    /// The middle of the start bit or of the stop bit has come.
    pub(crate) fn receive(&mut self) {
        let Some(mut arrival) = self.arrival.take() else {
            return;
        };
        if !arrival.confirmed {
            // A start bit that is over before its middle was noise.
            if !arrival.level_at(arrival.middle(0)) {
                arrival.confirmed = true;
                self.arrival = Some(arrival);
            }
            return;
        }
        let (bits, parity) = self.shape();
        let bit = |number: u64| arrival.level_at(arrival.middle(number));
        let character =
            (0..u64::from(bits)).fold(0, |sum, number| sum | u16::from(bit(number + 1)) << number);
        let odd_ones = character.count_ones() % 2 == 1;
        let wrong = parity.is_some_and(|odd| bit(u64::from(bits) + 1) != (odd_ones != odd));
        let framing = !bit(self.stop_bit());
        if self.incoming.len() == DEPTH || self.overrun {
            self.overrun = true;
        } else {
            self.events.came = true;
            self.incoming.push_back(ReceivedFrame {
                character,
                framing,
                parity: wrong,
            });
        }
    }

    /// Reads a register without taking from the queue.
    pub(crate) fn peek(&self, word: u8) -> Option<u32> {
        Some(match word {
            0 => self.mode,
            1 => self.status(),
            2 => 0,
            3 => self
                .incoming
                .front()
                .map_or(0, |received| u32::from(received.character)),
            4 => self.divider,
            _ => return None,
        })
    }

    fn status(&self) -> u32 {
        let flag = |set: bool, mask: u32| if set { mask } else { 0 };
        let front = self.incoming.front();
        self.status
            | flag(front.is_some(), AVAILABLE)
            | flag(self.overrun, OVERRUN)
            | flag(front.is_some_and(|received| received.framing), FRAMING)
            | flag(front.is_some_and(|received| received.parity), PARITY)
            | flag(self.arrival.is_none(), IDLE)
            | flag(self.shift.is_none() && self.outgoing.is_empty(), EMPTY)
            | flag(self.outgoing.len() >= DEPTH, FULL)
    }

    /// The program has read UxRXREG.
    pub(crate) fn take(&mut self) {
        self.incoming.pop_front();
    }

    /// Writes a register; `false` when a character was written into a full queue and lost.
    pub(crate) fn write(&mut self, word: u8, value: u32, now: Now) -> bool {
        let mut kept = true;
        match word {
            0 => self.mode = value & MODE_WRITABLE,
            1 => self.write_status(value),
            2 if self.is_on() => {
                kept = self.outgoing.len() < DEPTH;
                if kept {
                    self.outgoing.push_back(u16::try_from(value & 0x1FF).unwrap_or(0));
                }
            }
            4 => self.divider = value & 0xFFFF,
            _ => {}
        }
        if !self.is_on() {
            self.outgoing.clear();
            self.incoming.clear();
            (self.shift, self.arrival, self.overrun) = (None, None, false);
        }
        self.begin_frame(now);
        kept
    }

    fn write_status(&mut self, value: u32) {
        self.status = value & STATUS_WRITABLE;
        if self.overrun && value & OVERRUN == 0 {
            self.overrun = false;
            self.incoming.clear();
        }
        if !self.transmits() {
            self.outgoing.clear();
            self.shift = None;
        }
        if !self.receives() {
            self.arrival = None;
        }
    }

    pub(crate) fn lines(&self) -> Lines {
        let waiting = self.incoming.len();
        let front = self.incoming.front();
        Lines {
            error: self.overrun || front.is_some_and(|received| received.framing || received.parity),
            receive: match self.status >> 6 & 3 {
                0 | 1 => waiting > 0,
                2 => waiting >= DEPTH * 3 / 4,
                _ => waiting >= DEPTH,
            },
            transmit: self.transmits()
                && match self.status >> 14 {
                    0 => self.outgoing.len() < DEPTH,
                    1 => self.shift.is_none() && self.outgoing.is_empty(),
                    _ => self.outgoing.is_empty(),
                },
        }
    }
}
