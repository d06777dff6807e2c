//! Receiving by edges: change notice on RC13, at any rate up to 230,400 baud, measured from the other side's `U`.
//!
//! One interrupt serves all change notices. Those of other pins go on to the handler of the brush.

use cordlib::board::Received;
use pic32mx3_hal::change_notice::ChangeNotice;
use pic32mx3_hal::cpu;
use pic32mx3_hal::gpio::{Input, Pin, Port};
use pic32mx3_hal::interrupt::Source;
use soft_uart::{Baud, Level, Queued, Receiver};

use crate::board::link::brush;
use crate::board::off::mask;
use crate::generated::pins;
use crate::logic::edges::EdgeQueue;

/// Counts of the core timer per second; it timestamps the edges.
const CORE_HZ: u32 = 40_000_000;

/// Edges of the input, from the interrupt in `link.S` to the main loop.
pub static EDGES: EdgeQueue = EdgeQueue::new();

const RECEIVE: u16 = mask(pins::LINK_RECEIVE);

// The interrupt is written for this pin.
const _: () = assert!(RECEIVE == 1 << 13);

/// Events of one edge: at most the end of a byte and an error, so four are enough.
#[derive(Debug, Default)]
struct Events {
    events: [Option<Received>; 4],
}

impl Events {
    fn push(&mut self, event: soft_uart::Received) {
        let event = match event {
            soft_uart::Received::Byte(byte) => Received::Byte(byte),
            soft_uart::Received::FramingError | soft_uart::Received::Break => Received::FramingError,
            soft_uart::Received::Overrun => Received::Overrun,
        };
        if let Some(place) = self.events.iter_mut().find(|place| place.is_none()) {
            *place = Some(event);
        }
    }

    fn pop(&mut self) -> Option<Received> {
        let first = self.events.first_mut()?.take();
        self.events.rotate_left(1);
        first
    }
}

/// What the input is made of.
#[derive(Debug)]
#[allow(missing_docs, reason = "the types say what they are")]
pub struct EdgeParts {
    pub receive: Pin<'C', 13, Input>,
    pub brush: Pin<'B', 5, Input>,
    pub notice: ChangeNotice,
}

/// The input.
#[derive(Debug)]
pub struct EdgeInput {
    receiver: Receiver,
    events: Events,
    /// The interrupt has disabled itself, until the next millisecond.
    deaf: bool,
}

impl EdgeInput {
    /// Starts receiving at a rate, until a `U` shows another one.
    #[must_use]
    pub fn take(mut parts: EdgeParts, baud: Baud) -> Self {
        brush::watch(parts.brush, parts.notice);
        parts.receive.enable_pull_up();
        parts.receive.enable_notice();
        listen();
        Self {
            receiver: Receiver::starting_at(baud, CORE_HZ),
            events: Events::default(),
            deaf: false,
        }
    }

    /// Called once a millisecond: gives the interrupt its room for the next one. A pin that makes more edges than that is
    /// not listened to for the rest of the millisecond; what is lost counts as an overrun.
    pub fn service(&mut self) {
        EDGES.give_back();
        if core::mem::take(&mut self.deaf) {
            // Changes of the brush were not heard either.
            cpu::without_interrupts(brush::note_present_level);
            listen();
        }
    }

    /// The next event.
    pub fn next_event(&mut self) -> Option<Received> {
        if let Some(event) = self.events.pop() {
            return Some(event);
        }
        // Read before the queue is emptied: when `poll` ends a byte, all edges before that time have been decoded.
        let now = cpu::count();
        let events = &mut self.events;
        while let Some(queued) = EDGES.pop() {
            match queued {
                Queued::Edge(edge) => self.receiver.edge(edge, &mut |event| events.push(event)),
                Queued::Overrun => {
                    self.receiver.overrun(&mut |event| events.push(event));
                    self.deaf = true;
                }
            }
            if let Some(event) = events.pop() {
                return Some(event);
            }
        }
        self.receiver.poll(now, &mut |event| events.push(event));
        self.events.pop()
    }

    /// The rate of the other side.
    #[must_use]
    pub fn rate(&self) -> Option<Baud> {
        self.receiver.rate()
    }
}

/// Enables the interrupt, from the present level of the line.
pub(super) fn listen() {
    let high = Port::C.read() & RECEIVE != 0;
    EDGES.set_level(if high { Level::High } else { Level::Low });
    Source::ChangeNotice.clear();
    Source::ChangeNotice.enable();
}

/// The levels of port C. Reading the port updates the reference of the change notice, which could hide an edge of the
/// link at this moment; so the interrupt is triggered if there was one.
#[must_use]
pub fn port_c() -> u16 {
    let word = Port::C.read();
    let high = word & RECEIVE != 0;
    if high != (EDGES.level() == Level::High) {
        Source::ChangeNotice.request();
    }
    word
}
