//! The serial link to the Linux board, made by software: receive on RC13 by change notice, send on RB7 by Timer4.
//!
//! Both interrupts are in `link.S`. What they take and leave is in [`EDGES`] and [`RUNS`]; decoding and encoding are the main
//! loop's. One interrupt serves all change notices: those that are not of the link come here, to count the pulses of the main
//! brush.

use core::sync::atomic::{AtomicU32, Ordering};

use cordlib::board::{Link, Received};
use pic32mx3_hal::change_notice::ChangeNotice;
use pic32mx3_hal::gpio::{Input, Output, Pin, Port};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::timer::{Prescaler, Timer};
use pic32mx3_hal::{cpu, interrupt};
use soft_uart::{Baud, BitTime, Level, Queued, Receiver, Transmitter};

use super::off::mask;
use crate::generated::pins;
use crate::logic::edges::EdgeQueue;
use crate::logic::runs::RunRing;
use crate::logic::storm::Budget;

/// Rate until the other side's `U` tells another one: what the daemon uses if nobody changes its settings.
const BAUD: Baud = Baud::B230400;
/// Counts of the core timer a second, by which edges are stamped.
const CORE_HZ: u32 = 40_000_000;
/// Counts of Timer4 a second, prescaler 2: nine equal bits at 9600 baud are 37,500 counts then, which fit into 16 bits.
const TIMER_HZ: u32 = 40_000_000;
/// Counts until the first bit of a message: as soon as can be.
const BEGIN_COUNTS: u32 = 100;
/// Changes of the brush in a millisecond; a brush makes a few hundred in a second.
const BRUSH_PER_MS: u32 = 20;

/// Edges of the input, for the main loop.
pub static EDGES: EdgeQueue = EdgeQueue::new();
/// Levels and times of the output, for the interrupt.
pub static RUNS: RunRing = RunRing::new();

static BRUSH_BUDGET: Budget = Budget::new(BRUSH_PER_MS);
static BRUSH_PIN: HandlerCell<vector::CHANGE_NOTICE, Pin<'B', 5, Input>> = HandlerCell::empty();
static BRUSH_LEVEL: AtomicU32 = AtomicU32::new(0);
static BRUSH_PULSES: AtomicU32 = AtomicU32::new(0);

const RECEIVE: u16 = mask(pins::LINK_RECEIVE);
const BRUSH: u16 = mask(pins::BRUSH_MAIN_ENCODER);

// The interrupts are written for these pins.
const _: () = assert!(RECEIVE == 1 << 13 && mask(pins::LINK_TRANSMIT) == 1 << 7);

/// A change that was not the link's. If one of the link came together with it, the request stays up and the interrupt comes
/// again.
fn on_other_change(context: &mut Context<vector::CHANGE_NOTICE>) {
    let level = u32::from(Port::B.read() & BRUSH);
    Source::ChangeNotice.clear();
    if level != BRUSH_LEVEL.load(Ordering::Relaxed) {
        BRUSH_LEVEL.store(level, Ordering::Relaxed);
        // Active low: a pulse begins with the falling edge.
        let pulses = BRUSH_PULSES.load(Ordering::Relaxed);
        BRUSH_PULSES.store(pulses.wrapping_add(u32::from(level == 0)), Ordering::Relaxed);
    }
    if let Some(brush) = BRUSH_PIN.get(context) {
        if BRUSH_BUDGET.spend() {
            brush.enable_notice();
        } else {
            brush.disable_notice();
        }
    }
}
interrupt!(CHANGE_NOTICE, on_other_change);

/// The link.
#[derive(Debug)]
pub struct SerialLink {
    receiver: Receiver,
    events: Events,
    transmitter: Transmitter,
    baud: Baud,
    timer: Timer<4>,
}

/// Events that one edge led to; a byte that ended and an error at most, so four are plenty.
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

/// What the link is made of.
#[derive(Debug)]
#[allow(missing_docs, reason = "the types say what they are")]
pub struct LinkParts {
    pub receive: Pin<'C', 13, Input>,
    pub transmit: Pin<'B', 7, Output>,
    pub brush: Pin<'B', 5, Input>,
    pub timer: Timer<4>,
    pub notice: ChangeNotice,
}

impl SerialLink {
    /// Starts receiving. From here on the interrupt sets the output.
    #[must_use]
    pub fn take(mut parts: LinkParts) -> Self {
        parts.transmit.set_high();
        interrupt::set_priority(Vector::Timer4, Priority::Level6, SubPriority::Sub1).ok();
        Source::Timer4.clear();
        Source::Timer4.enable();

        parts.receive.enable_pull_up();
        parts.receive.enable_notice();
        parts.brush.enable_notice();
        BRUSH_LEVEL.store(u32::from(Port::B.read() & BRUSH), Ordering::Relaxed);
        parts.notice.start();
        interrupt::set_priority(Vector::ChangeNotice, Priority::Level6, SubPriority::Sub2).ok();
        let link = Self {
            receiver: Receiver::starting_at(BAUD, CORE_HZ),
            events: Events::default(),
            transmitter: Transmitter::new(BitTime::new(BAUD, TIMER_HZ)),
            baud: BAUD,
            timer: parts.timer,
        };
        // Given once, because `Peripherals` gives its pins once.
        BRUSH_PIN.hand_over(parts.brush).ok();
        listen();
        link
    }

    /// To be called once in a millisecond: a brush whose line was switched off for noise gets another chance.
    pub fn service(&mut self) {
        if BRUSH_BUDGET.renew() {
            // Its handler owns the line, and lets it come again.
            Source::ChangeNotice.request();
        }
    }

    /// A new rate is taken over between two messages, so that none is torn.
    fn follow_rate(&mut self) {
        if let Some(baud) = self.receiver.rate()
            && baud != self.baud
            && RUNS.is_quiet()
        {
            self.baud = baud;
            self.transmitter.set_bit_time(BitTime::new(baud, TIMER_HZ));
        }
    }
}

/// Lets the interrupt of the input come, from the level that the line has now.
fn listen() {
    let high = Port::C.read() & RECEIVE != 0;
    EDGES.set_level(if high { Level::High } else { Level::Low });
    Source::ChangeNotice.clear();
    Source::ChangeNotice.enable();
}

impl Link for SerialLink {
    fn receive(&mut self) -> Option<Received> {
        if let Some(event) = self.events.pop() {
            return Some(event);
        }
        // Read before the queue is emptied: every edge before it has been seen when `poll` says that a byte has ended.
        let now = cpu::count();
        let events = &mut self.events;
        while let Some(queued) = EDGES.pop() {
            match queued {
                Queued::Edge(edge) => self.receiver.edge(edge, &mut |event| events.push(event)),
                Queued::Overrun => {
                    self.receiver.overrun(&mut |event| events.push(event));
                    listen();
                }
            }
            if let Some(event) = events.pop() {
                return Some(event);
            }
        }
        self.receiver.poll(now, &mut |event| events.push(event));
        self.follow_rate();
        self.events.pop()
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        let taken = RUNS.push(&mut self.transmitter, bytes);
        // When the interrupt comes between, it finds nothing and stops the timer, or goes on with what was pushed.
        if cpu::without_interrupts(|| RUNS.must_start()) {
            self.timer.start(Prescaler::By2, BEGIN_COUNTS);
        }
        taken
    }
}

/// Pulses of the main brush since the start, wrapping.
pub(super) fn brush_pulses() -> u32 {
    BRUSH_PULSES.load(Ordering::Relaxed)
}

/// The levels of port C. Reading the port tells the change notice that they are known, which could swallow an edge of the link
/// that comes at this very moment; so the interrupt is called if there was one.
pub(super) fn port_c() -> u16 {
    let word = Port::C.read();
    let high = word & RECEIVE != 0;
    if high != (EDGES.level() == Level::High) {
        Source::ChangeNotice.request();
    }
    word
}
