//! Receiving by edges: change notice on RC13, at any rate up to 230,400 baud, measured from the other side's `U`.
//!
//! One interrupt serves all change notices. Those of other pins go to the handler here, which counts the pulses of the
//! main brush.

use core::sync::atomic::{AtomicU32, Ordering};

use cordlib::board::Received;
use pic32mx3_hal::change_notice::ChangeNotice;
use pic32mx3_hal::gpio::{Input, Pin, Port};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::{cpu, interrupt};
use soft_uart::{Baud, Level, Queued, Receiver};

use crate::board::off::mask;
use crate::generated::pins;
use crate::logic::edges::EdgeQueue;
use crate::logic::interrupt_rate::InterruptRateLimit;

/// Counts of the core timer per second; it timestamps the edges.
const CORE_HZ: u32 = 40_000_000;
/// Changes of the brush in a millisecond; a brush makes a few hundred in a second.
const BRUSH_PER_MS: u32 = 20;

/// Edges of the input, from the interrupt in `link.S` to the main loop.
pub static EDGES: EdgeQueue = EdgeQueue::new();

static BRUSH_BUDGET: InterruptRateLimit = InterruptRateLimit::new(BRUSH_PER_MS);
static BRUSH_PIN: HandlerCell<vector::CHANGE_NOTICE, Pin<'B', 5, Input>> = HandlerCell::empty();
static BRUSH_LEVEL: AtomicU32 = AtomicU32::new(0);
static BRUSH_PULSES: AtomicU32 = AtomicU32::new(0);
/// Not 0 while the line of the brush is disabled for noise.
static BRUSH_OFF: AtomicU32 = AtomicU32::new(0);

const RECEIVE: u16 = mask(pins::LINK_RECEIVE);
const BRUSH: u16 = mask(pins::BRUSH_MAIN_ENCODER);

// The interrupt is written for this pin.
const _: () = assert!(RECEIVE == 1 << 13);

/// A change of another pin. If the link changed at the same time, the request stays set and the interrupt comes again.
fn on_other_change(context: &mut Context<vector::CHANGE_NOTICE>) {
    let level = u32::from(Port::B.read() & BRUSH);
    Source::ChangeNotice.clear();
    note_brush(level);
    if let Some(brush) = BRUSH_PIN.get(context) {
        let is_on = BRUSH_BUDGET.spend();
        BRUSH_OFF.store(u32::from(!is_on), Ordering::Relaxed);
        if is_on {
            brush.enable_notice();
        } else {
            brush.disable_notice();
        }
    }
}
interrupt!(CHANGE_NOTICE, on_other_change);

fn note_brush(level: u32) {
    if level != BRUSH_LEVEL.load(Ordering::Relaxed) {
        BRUSH_LEVEL.store(level, Ordering::Relaxed);
        // Active low: a pulse begins with the falling edge.
        let pulses = BRUSH_PULSES.load(Ordering::Relaxed);
        BRUSH_PULSES.store(pulses.wrapping_add(u32::from(level == 0)), Ordering::Relaxed);
    }
}

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
        watch(parts.brush, parts.notice);
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
            cpu::without_interrupts(|| note_brush(u32::from(Port::B.read() & BRUSH)));
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

/// Starts the change notice with the brush, whose handler owns its line.
pub(super) fn watch(mut brush: Pin<'B', 5, Input>, mut notice: ChangeNotice) {
    brush.enable_notice();
    BRUSH_LEVEL.store(u32::from(Port::B.read() & BRUSH), Ordering::Relaxed);
    // Given once, because `Peripherals` gives its pins once.
    BRUSH_PIN.hand_over(brush).ok();
    notice.start();
    interrupt::set_priority(Vector::ChangeNotice, Priority::Level6, SubPriority::Sub2).ok();
}

/// Enables the interrupt, from the present level of the line.
pub(super) fn listen() {
    let high = Port::C.read() & RECEIVE != 0;
    EDGES.set_level(if high { Level::High } else { Level::Low });
    Source::ChangeNotice.clear();
    Source::ChangeNotice.enable();
}

/// Called once a millisecond: enables the brush's line again if it was disabled for noise. An edge of the link may take
/// the request away, so it is repeated until it was heard.
pub(super) fn service_brush() {
    if BRUSH_BUDGET.renew() || BRUSH_OFF.load(Ordering::Relaxed) != 0 {
        Source::ChangeNotice.request();
    }
}

/// Pulses of the main brush since the start, wrapping.
#[must_use]
pub fn brush_pulses() -> u32 {
    BRUSH_PULSES.load(Ordering::Relaxed)
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
