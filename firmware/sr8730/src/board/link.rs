//! The serial link to the Linux board, made by software: receive on RC13 by change notice, send on RB7 by Timer4.
//!
//! The change-notice interrupt has the highest level and does nothing for the link but note the time and the level. One
//! interrupt serves all change notices, so it also counts the pulses of the main brush.

use core::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, Ordering};

use cordlib::board::{Link, Received};
use pic32mx3_hal::change_notice::ChangeNotice;
use pic32mx3_hal::gpio::{Input, Output, Pin, Port};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::timer::{Prescaler, Timer};
use pic32mx3_hal::{cpu, interrupt};
use soft_uart::{Baud, BitTime, ByteRing, Due, Edge, EdgeRing, Level, Queued, Receiver, Transmitter};

use super::off::mask;
use crate::generated::pins;
use crate::logic::storm::Budget;

/// Rate until the other side's `U` tells another one: what the daemon uses if nobody changes its settings.
const BAUD: Baud = Baud::B230400;
/// Counts of the core timer a second, by which edges are stamped.
const CORE_HZ: u32 = 40_000_000;
/// Counts of Timer4 a second, prescaler 2: nine equal bits at 9600 baud are 37,500 counts then, which fit into 16 bits.
const TIMER_HZ: u32 = 40_000_000;
/// Length of a bit at each rate, reckoned here and not in the handler.
const BIT_TIMES: [BitTime; Baud::ALL.len()] = {
    let mut times = [BitTime::new(BAUD, TIMER_HZ); Baud::ALL.len()];
    let mut index = 0;
    while index < times.len() {
        times[index] = BitTime::new(Baud::ALL[index], TIMER_HZ);
        index += 1;
    }
    times
};
/// Counts until the first bit of a message: as soon as can be.
const BEGIN_COUNTS: u32 = 100;
/// Change notices in a millisecond: 230 edges of the link at 230,400 baud, and the brush.
const CHANGES_PER_MS: u32 = 400;
/// Edges that wait for the main loop: 2.2 ms of the densest pattern at the highest rate.
const EDGES: usize = 512;
/// Bytes that wait to be sent.
const BYTES: usize = 512;

static RECEIVED: EdgeRing<EDGES> = EdgeRing::new();
static TO_SEND: ByteRing<BYTES> = ByteRing::new();
static BUDGET: Budget = Budget::new(CHANGES_PER_MS);
/// Level of the input at the last edge.
static LEVEL: AtomicU32 = AtomicU32::new(0);
static BRUSH_LEVEL: AtomicU32 = AtomicU32::new(0);
static BRUSH_PULSES: AtomicU32 = AtomicU32::new(0);
/// Timer4 runs.
static SENDING: AtomicBool = AtomicBool::new(false);
/// Index of the rate to send with, in [`Baud::ALL`].
static RATE: AtomicU8 = AtomicU8::new(0);
static SENDER: HandlerCell<vector::TIMER_4, Sender> = HandlerCell::empty();

const RECEIVE: u16 = mask(pins::LINK_RECEIVE);
const BRUSH: u16 = mask(pins::BRUSH_MAIN_ENCODER);

fn on_change(_: &mut Context<vector::CHANGE_NOTICE>) {
    let at = cpu::count();
    let level = u32::from(Port::C.read() & RECEIVE);
    if level != LEVEL.load(Ordering::Relaxed) {
        LEVEL.store(level, Ordering::Relaxed);
        let level = if level == 0 { Level::Low } else { Level::High };
        RECEIVED.push(Edge { at, level });
    }
    let brush = u32::from(Port::B.read() & BRUSH);
    Source::ChangeNotice.clear();
    if brush != BRUSH_LEVEL.load(Ordering::Relaxed) {
        BRUSH_LEVEL.store(brush, Ordering::Relaxed);
        // Active low: a pulse begins with the falling edge.
        let pulses = BRUSH_PULSES.load(Ordering::Relaxed);
        BRUSH_PULSES.store(pulses.wrapping_add(u32::from(brush == 0)), Ordering::Relaxed);
    }
    if !BUDGET.spend() {
        Source::ChangeNotice.disable();
    }
}
interrupt!(CHANGE_NOTICE, on_change);

/// What the sending handler owns.
#[derive(Debug)]
struct Sender {
    transmitter: Transmitter,
    timer: Timer<4>,
    pin: Pin<'B', 7, Output>,
    rate: u8,
}

fn on_bit(context: &mut Context<vector::TIMER_4>) {
    Source::Timer4.clear();
    let Some(sender) = SENDER.get(context) else {
        return;
    };
    match sender.transmitter.due() {
        Due::Run { level, counts } => {
            // First the pin, at the same distance from the interrupt each time.
            match level {
                Level::Low => sender.pin.set_low(),
                Level::High => sender.pin.set_high(),
            }
            sender.timer.set_period(counts);
            sender.transmitter.prepare(|| TO_SEND.pop());
        }
        Due::Idle => sender.rest(),
    }
}
interrupt!(TIMER_4, on_bit);

impl Sender {
    /// Between two messages: takes over a new rate, and begins anew if there is something to send by now.
    fn rest(&mut self) {
        let rate = RATE.load(Ordering::Relaxed);
        if rate != self.rate
            && let Some(time) = BIT_TIMES.get(usize::from(rate))
        {
            self.rate = rate;
            self.transmitter.set_bit_time(*time);
        }
        self.transmitter.prepare(|| TO_SEND.pop());
        if self.transmitter.due() == Due::Idle {
            self.timer.stop();
            SENDING.store(false, Ordering::Relaxed);
        } else if SENDING.load(Ordering::Relaxed) {
            self.timer.set_period(BEGIN_COUNTS);
        } else {
            SENDING.store(true, Ordering::Relaxed);
            self.timer.start(Prescaler::By2, BEGIN_COUNTS);
        }
    }
}

/// The link.
#[derive(Debug)]
pub struct SerialLink {
    receiver: Receiver,
    events: Events,
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
    /// Starts receiving.
    #[must_use]
    pub fn take(mut parts: LinkParts) -> Self {
        let rate = Baud::ALL
            .iter()
            .position(|baud| *baud == BAUD)
            .unwrap_or_default() as u8;
        RATE.store(rate, Ordering::Relaxed);
        parts.transmit.set_high();
        let sender = Sender {
            transmitter: Transmitter::new(BitTime::new(BAUD, TIMER_HZ)),
            timer: parts.timer,
            pin: parts.transmit,
            rate,
        };
        // Given once, because `Peripherals` gives the timer once.
        SENDER.hand_over(sender).ok();
        interrupt::set_priority(Vector::Timer4, Priority::Level5, SubPriority::Sub0).ok();
        Source::Timer4.enable();

        parts.receive.enable_pull_up();
        parts.receive.enable_notice();
        parts.brush.enable_notice();
        LEVEL.store(u32::from(Port::C.read() & RECEIVE), Ordering::Relaxed);
        BRUSH_LEVEL.store(u32::from(Port::B.read() & BRUSH), Ordering::Relaxed);
        parts.notice.start();
        Source::ChangeNotice.clear();
        interrupt::set_priority(Vector::ChangeNotice, Priority::Level6, SubPriority::Sub0).ok();
        Source::ChangeNotice.enable();
        Self {
            receiver: Receiver::starting_at(BAUD, CORE_HZ),
            events: Events::default(),
        }
    }

    /// To be called once in a millisecond: an input that was switched off for noise gets another chance.
    pub fn service(&mut self) {
        if BUDGET.renew() {
            Source::ChangeNotice.enable();
        }
    }

    fn follow_rate(&self) {
        let rate = self.receiver.rate();
        let index = Baud::ALL.iter().position(|baud| Some(*baud) == rate);
        if let Some(index) = index {
            RATE.store(index as u8, Ordering::Relaxed);
        }
    }
}

impl Link for SerialLink {
    fn receive(&mut self) -> Option<Received> {
        if let Some(event) = self.events.pop() {
            return Some(event);
        }
        // Read before the queue is emptied: every edge before it has been seen when `poll` says that a byte has ended.
        let now = cpu::count();
        let events = &mut self.events;
        while let Some(queued) = RECEIVED.pop() {
            match queued {
                Queued::Edge(edge) => self.receiver.edge(edge, &mut |event| events.push(event)),
                Queued::Overrun => self.receiver.overrun(&mut |event| events.push(event)),
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
        let taken = TO_SEND.push(bytes);
        // The handler cannot come between the look and the request, and when it runs it will see these bytes.
        cpu::with_level(Priority::Level5, || {
            if taken != 0 && !SENDING.load(Ordering::Relaxed) {
                Source::Timer4.request();
            }
        });
        taken
    }
}

/// Pulses of the main brush since the start, wrapping.
pub(super) fn brush_pulses() -> u32 {
    BRUSH_PULSES.load(Ordering::Relaxed)
}

/// The levels of port C. Reading the port tells the change notice that they are known, which could swallow an edge of the link
/// that comes at this very moment; so the handler is called if there was one.
pub(super) fn port_c() -> u16 {
    let word = Port::C.read();
    if u32::from(word & RECEIVE) != LEVEL.load(Ordering::Relaxed) {
        Source::ChangeNotice.request();
    }
    word
}
