//! Receiving by samples, for a board on which RC13 does not reach the connector: RB6 (PGC2) has no change notice, so
//! Timer5 reads it at three times 57,600 baud. One rate, no `U`.
//!
//! Timer5 is also the second clock of the self-checks; the number of samples replaces it.

use core::sync::atomic::{AtomicU32, Ordering};

use cordlib::board::Received;
use pic32mx3_hal::change_notice::ChangeNotice;
use pic32mx3_hal::gpio::{Input, Pin, Port};
use pic32mx3_hal::interrupt;
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::timer::{Prescaler, Timer};
use soft_uart::{Baud, ByteRing, Level, Sampler};

use super::by_edges;
use crate::board::link::brush;
use crate::board::off::mask;
use crate::generated::pins;

/// The rate.
pub const BAUD: Baud = Baud::B57600;
/// Counts of Timer5 from one sample to the next: 80 MHz / (3 x 57,600) = 462.96.
const SAMPLE_COUNTS: u32 = 463;
/// Counts of the core timer from one sample to the next, in halves: 231.5.
pub const CORE_HALVES_PER_SAMPLE: u32 = SAMPLE_COUNTS;
const RECEIVE: u16 = mask(pins::LINK_RECEIVE_SAMPLED);

static RECEIVED: ByteRing<256> = ByteRing::new();
/// Bytes without stop bit, and bytes lost because the queue was full.
static BROKEN: AtomicU32 = AtomicU32::new(0);
static LOST: AtomicU32 = AtomicU32::new(0);
static SAMPLES: AtomicU32 = AtomicU32::new(0);
static SAMPLER: HandlerCell<vector::TIMER_5, Sampler> = HandlerCell::empty();

fn on_sample(context: &mut Context<vector::TIMER_5>) {
    let high = Port::B.read() & RECEIVE != 0;
    Source::Timer5.clear();
    add_one(&SAMPLES);
    let level = if high { Level::High } else { Level::Low };
    match SAMPLER.get(context).and_then(|sampler| sampler.sample(level)) {
        None => {}
        Some(soft_uart::Received::Byte(byte)) if RECEIVED.push(&[byte]) == 1 => {}
        Some(soft_uart::Received::FramingError | soft_uart::Received::Break) => add_one(&BROKEN),
        Some(soft_uart::Received::Byte(_) | soft_uart::Received::Overrun) => add_one(&LOST),
    }
}
interrupt!(TIMER_5, on_sample);

#[inline(always)]
fn add_one(counter: &AtomicU32) {
    counter.store(counter.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

/// What the input is made of.
#[derive(Debug)]
#[allow(missing_docs, reason = "the types say what they are")]
pub struct SampledParts {
    pub receive: Pin<'B', 6, Input>,
    pub brush: Pin<'B', 5, Input>,
    pub notice: ChangeNotice,
    pub timer: Timer<5>,
}

/// The input.
#[derive(Debug)]
pub struct SampledInput {
    broken: u32,
    lost: u32,
}

impl SampledInput {
    /// Starts receiving at the fixed rate.
    #[must_use]
    pub fn take(mut parts: SampledParts, _: Baud) -> Self {
        brush::watch(parts.brush, parts.notice);
        by_edges::listen();
        // Given once, because `Peripherals` gives the timer once.
        SAMPLER.hand_over(Sampler::new()).ok();
        interrupt::set_priority(Vector::Timer5, Priority::Level6, SubPriority::Sub2).ok();
        parts.timer.start(Prescaler::By1, SAMPLE_COUNTS);
        Source::Timer5.enable();
        Self { broken: 0, lost: 0 }
    }

    /// Called once a millisecond. The rate of the samples is fixed, whatever the pin does.
    pub const fn service(&mut self) {}

    /// The next event; errors after the bytes that were received.
    pub fn next_event(&mut self) -> Option<Received> {
        if let Some(byte) = RECEIVED.pop() {
            return Some(Received::Byte(byte));
        }
        if BROKEN.load(Ordering::Relaxed) != self.broken {
            self.broken = self.broken.wrapping_add(1);
            return Some(Received::FramingError);
        }
        if LOST.load(Ordering::Relaxed) != self.lost {
            self.lost = LOST.load(Ordering::Relaxed);
            return Some(Received::Overrun);
        }
        None
    }

    /// The rate.
    #[must_use]
    pub const fn rate(&self) -> Option<Baud> {
        Some(BAUD)
    }
}

/// Samples taken since the start, modulo 2^16.
#[must_use]
pub fn samples() -> u16 {
    SAMPLES.load(Ordering::Relaxed) as u16
}
