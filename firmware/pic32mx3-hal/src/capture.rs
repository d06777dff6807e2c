//! Input capture: the count of timer 2 or 3 at an edge of a pin (section 12).

use crate::gpio::{Input, Pin};
use crate::interrupt::Source;
use crate::register::map::{capture_buffer, capture_control};

const ON: u32 = 1 << 15;
const NOT_EMPTY: u32 = 1 << 3;
const OVERFLOW: u32 = 1 << 4;
const USE_TIMER_2: u32 = 1 << 7;
/// Captures that fit into the queue; the number is general knowledge of the family.
const QUEUE: usize = 4;

/// Input capture `NUMBER`, 1 to 5.
#[derive(Debug)]
pub struct InputCapture<const NUMBER: u8>(());

/// Which edges are captured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CaptureEdge {
    /// Every edge.
    Both = 1,
    /// From high to low.
    Falling = 2,
    /// From low to high.
    Rising = 3,
    /// Every fourth from low to high.
    FourthRising = 4,
    /// Every sixteenth from low to high.
    SixteenthRising = 5,
}

/// The timer whose count is taken. It must run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CaptureTimer {
    /// Timer 2.
    Timer2,
    /// Timer 3.
    Timer3,
}

impl<const NUMBER: u8> InputCapture<NUMBER> {
    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Starts it, with a request for service at each capture.
    pub fn start<P: CapturePin<NUMBER>>(
        self,
        pin: P,
        edge: CaptureEdge,
        timer: CaptureTimer,
    ) -> Capture<NUMBER, P> {
        let timer = match timer {
            CaptureTimer::Timer2 => USE_TIMER_2,
            CaptureTimer::Timer3 => 0,
        };
        capture_control(NUMBER).write(0);
        let capture = Capture { unit: self, pin };
        while capture.take().is_some() {}
        Capture::<NUMBER, P>::SOURCE.clear();
        capture_control(NUMBER).write(ON | timer | edge as u32);
        capture
    }
}

/// The pin of an input capture.
pub trait CapturePin<const CAPTURE: u8> {}

macro_rules! capture_pins {
    ($($capture:literal $number:literal;)*) => {
        $(impl CapturePin<$capture> for Pin<'D', $number, Input> {})*
    };
}

capture_pins! {
    1 8;
    2 9;
    3 10;
    4 11;
    5 12;
}

/// A pin whose edges are captured.
#[derive(Debug)]
pub struct Capture<const NUMBER: u8, P> {
    unit: InputCapture<NUMBER>,
    pin: P,
}

impl<const NUMBER: u8, P> Capture<NUMBER, P> {
    /// Its source of interrupts.
    pub const SOURCE: Source = match NUMBER {
        1 => Source::InputCapture1,
        2 => Source::InputCapture2,
        3 => Source::InputCapture3,
        4 => Source::InputCapture4,
        5 => Source::InputCapture5,
        _ => panic!("input captures are 1 to 5"),
    };

    /// The oldest capture in the queue: the timer's count. A handler takes all, then clears the source.
    #[inline(always)]
    pub fn take(&self) -> Option<u16> {
        capture_control(NUMBER)
            .has(NOT_EMPTY)
            .then(|| capture_buffer(NUMBER).read() as u16)
    }

    /// Whether captures were lost because the queue was full. Taking one forgets it.
    #[inline(always)]
    #[must_use]
    pub fn has_overflowed(&self) -> bool {
        capture_control(NUMBER).has(OVERFLOW)
    }

    /// Takes all captures that are in the queue now, at most as many as it holds, and returns how many. For counting edges
    /// in a handler.
    #[inline(always)]
    pub fn drain(&self) -> usize {
        let mut taken = 0;
        while taken < QUEUE && self.take().is_some() {
            taken += 1;
        }
        taken
    }

    /// The pin, to read its level.
    #[must_use]
    pub const fn pin(&self) -> &P {
        &self.pin
    }

    /// Stops and gives the parts back.
    #[must_use]
    pub fn release(self) -> (InputCapture<NUMBER>, P) {
        capture_control(NUMBER).write(0);
        (self.unit, self.pin)
    }
}
