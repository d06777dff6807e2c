//! The change notice, one interrupt for all pins that have one: pulses of the main brush, and what a link by SPI hears on it.
//!
//! With a serial link the interrupt is entered in `link.S`, which takes the edges of the link and hands on all others.

use core::sync::atomic::{AtomicU32, Ordering};

use pic32mx3_hal::change_notice::ChangeNotice;
use pic32mx3_hal::gpio::{Input, Pin, Port};
use pic32mx3_hal::interrupt;
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};

use crate::board::off::mask;
use crate::generated::pins;
use crate::logic::interrupt_rate::InterruptRateLimit;

/// Changes of the brush in a millisecond; a brush makes a few hundred in a second.
const BRUSH_PER_MS: u32 = 20;

static BRUSH_BUDGET: InterruptRateLimit = InterruptRateLimit::new(BRUSH_PER_MS);
static BRUSH_PIN: HandlerCell<vector::CHANGE_NOTICE, Pin<'B', 5, Input>> = HandlerCell::empty();
static BRUSH_LEVEL: AtomicU32 = AtomicU32::new(0);
static BRUSH_PULSES: AtomicU32 = AtomicU32::new(0);
/// Not 0 while the line of the brush is disabled for noise.
static BRUSH_OFF: AtomicU32 = AtomicU32::new(0);

const BRUSH: u16 = mask(pins::BRUSH_MAIN_ENCODER);

/// A change. If a serial link changed at the same time, the request stays set and the interrupt comes again.
fn on_change(context: &mut Context<vector::CHANGE_NOTICE>) {
    let level = u32::from(Port::B.read() & BRUSH);
    #[cfg(feature = "link-spi")]
    let select = Port::C.read();
    Source::ChangeNotice.clear();
    #[cfg(feature = "link-spi")]
    super::spi::note_select(select);
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
interrupt!(CHANGE_NOTICE, on_change);

fn note_brush(level: u32) {
    if level != BRUSH_LEVEL.load(Ordering::Relaxed) {
        BRUSH_LEVEL.store(level, Ordering::Relaxed);
        // Active low: a pulse begins with the falling edge.
        let pulses = BRUSH_PULSES.load(Ordering::Relaxed);
        BRUSH_PULSES.store(pulses.wrapping_add(u32::from(level == 0)), Ordering::Relaxed);
    }
}

/// Notes the level that the brush has now: changes of it were not heard. Not from a handler, and with interrupts off.
#[cfg(serial_link)]
pub(super) fn note_present_level() {
    note_brush(u32::from(Port::B.read() & BRUSH));
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

/// Called once a millisecond: enables the brush's line again if it was disabled for noise. An edge of the link may take
/// the request away, so it is repeated until it was heard.
pub(super) fn service() {
    if BRUSH_BUDGET.renew() || BRUSH_OFF.load(Ordering::Relaxed) != 0 {
        Source::ChangeNotice.request();
    }
}

/// Pulses of the main brush since the start, wrapping.
#[must_use]
pub fn brush_pulses() -> u32 {
    BRUSH_PULSES.load(Ordering::Relaxed)
}
