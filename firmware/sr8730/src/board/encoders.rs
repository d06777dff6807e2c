//! The wheels' encoders on the input captures IC1 to IC4.
//!
//! Each edge interrupts. The count follows from the levels of both lines, not from the captured times. A wheel with one
//! dead line then shows illegal transitions or none, instead of half the speed in an unknown direction.

use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use cordlib::board::{Encoders, WheelCounts};
use pic32mx3_hal::capture::{Capture, CaptureEdge, CaptureTimer, InputCapture};
use pic32mx3_hal::gpio::{Input, Pin};
use pic32mx3_hal::interrupt;
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use rvac_protocol::message::EncoderProbe;

use super::link::brush::brush_pulses;
use super::off::{mask, port};
use crate::calibration::Calibration;
use crate::generated::calibration::Calibrated;
use crate::generated::pins::{self, Signal};
use crate::logic::interrupt_rate::InterruptRateLimit;
use crate::logic::quadrature::{Levels, PhaseOrder, Step, step};

/// Edges of one line in a millisecond: a wheel at full speed makes one, so this is noise.
const EDGES_PER_MS: u32 = 40;

/// Count of one wheel, written by its two handlers, which have the same interrupt level.
#[derive(Debug)]
struct WheelCount {
    lines: [Signal; 2],
    levels: AtomicU8,
    total: AtomicU32,
    illegal: AtomicU32,
}

static LEFT: WheelCount = WheelCount::new([pins::WHEEL_LEFT_ENCODER_1, pins::WHEEL_LEFT_ENCODER_2]);
static RIGHT: WheelCount = WheelCount::new([pins::WHEEL_RIGHT_ENCODER_1, pins::WHEEL_RIGHT_ENCODER_2]);
static RATE_LIMITS: [InterruptRateLimit; 4] = [const { InterruptRateLimit::new(EDGES_PER_MS) }; 4];

type Line1 = Capture<1, Pin<'D', 8, Input>>;
type Line2 = Capture<2, Pin<'D', 9, Input>>;
type Line3 = Capture<3, Pin<'D', 10, Input>>;
type Line4 = Capture<4, Pin<'D', 11, Input>>;

static CAPTURE_1: HandlerCell<vector::INPUT_CAPTURE_1, Line1> = HandlerCell::empty();
static CAPTURE_2: HandlerCell<vector::INPUT_CAPTURE_2, Line2> = HandlerCell::empty();
static CAPTURE_3: HandlerCell<vector::INPUT_CAPTURE_3, Line3> = HandlerCell::empty();
static CAPTURE_4: HandlerCell<vector::INPUT_CAPTURE_4, Line4> = HandlerCell::empty();

/// IC1 and IC2 are the left wheel's lines 1 and 2; IC4 and IC3 the right wheel's, in this order.
macro_rules! on_edge {
    ($handler:ident, $vector:ident, $cell:ident, $source:ident, $budget:literal, $wheel:ident) => {
        fn $handler(context: &mut Context<vector::$vector>) {
            if let Some(capture) = $cell.get(context) {
                capture.drain();
            }
            Source::$source.clear();
            if !RATE_LIMITS[$budget].spend() {
                Source::$source.disable();
            }
            $wheel.look();
        }
        interrupt!($vector, $handler);
    };
}

on_edge!(on_line_1, INPUT_CAPTURE_1, CAPTURE_1, InputCapture1, 0, LEFT);
on_edge!(on_line_2, INPUT_CAPTURE_2, CAPTURE_2, InputCapture2, 1, LEFT);
on_edge!(on_line_3, INPUT_CAPTURE_3, CAPTURE_3, InputCapture3, 2, RIGHT);
on_edge!(on_line_4, INPUT_CAPTURE_4, CAPTURE_4, InputCapture4, 3, RIGHT);

const SOURCES: [Source; 4] = [
    Source::InputCapture1,
    Source::InputCapture2,
    Source::InputCapture3,
    Source::InputCapture4,
];

impl WheelCount {
    const fn new(lines: [Signal; 2]) -> Self {
        Self {
            lines,
            levels: AtomicU8::new(0),
            total: AtomicU32::new(0),
            illegal: AtomicU32::new(0),
        }
    }

    #[inline(always)]
    fn read(&self) -> Levels {
        let [first, second] = self.lines;
        // Both lines of a wheel are on one port, so one reading shows both at one moment.
        let word = port(first).read();
        u8::from(word & mask(first) != 0) | u8::from(word & mask(second) != 0) << 1
    }

    #[inline(always)]
    fn look(&self) {
        let now = self.read();
        let change = match step(self.levels.load(Ordering::Relaxed), now) {
            Step::None => return,
            Step::Up => 1,
            Step::Down => u32::MAX,
            Step::Illegal => {
                let illegal = self.illegal.load(Ordering::Relaxed).wrapping_add(1);
                self.illegal.store(illegal, Ordering::Relaxed);
                0
            }
        };
        self.levels.store(now, Ordering::Relaxed);
        let total = self.total.load(Ordering::Relaxed).wrapping_add(change);
        self.total.store(total, Ordering::Relaxed);
    }

    fn total(&self) -> i32 {
        self.total.load(Ordering::Relaxed).cast_signed()
    }
}

/// The capture units and their pins.
#[derive(Debug)]
#[allow(missing_docs, reason = "numbers are those of the chip")]
pub struct EncoderLines {
    pub capture1: (InputCapture<1>, Pin<'D', 8, Input>),
    pub capture2: (InputCapture<2>, Pin<'D', 9, Input>),
    pub capture3: (InputCapture<3>, Pin<'D', 10, Input>),
    pub capture4: (InputCapture<4>, Pin<'D', 11, Input>),
}

/// Both encoders.
#[derive(Debug)]
pub struct WheelEncoders {
    left: PhaseOrder,
    right: PhaseOrder,
    calibrated: bool,
}

impl WheelEncoders {
    /// Starts counting. Timer3, which runs for the motors, is the time base of the captures; their times are not used.
    #[must_use]
    pub fn take(lines: EncoderLines, calibration: &Calibration) -> Self {
        let (edge, timer) = (CaptureEdge::Both, CaptureTimer::Timer3);
        // Each is given once, because `Peripherals` gives its parts once.
        let (unit, pin) = lines.capture1;
        CAPTURE_1.hand_over(unit.start(pin, edge, timer)).ok();
        let (unit, pin) = lines.capture2;
        CAPTURE_2.hand_over(unit.start(pin, edge, timer)).ok();
        let (unit, pin) = lines.capture3;
        CAPTURE_3.hand_over(unit.start(pin, edge, timer)).ok();
        let (unit, pin) = lines.capture4;
        CAPTURE_4.hand_over(unit.start(pin, edge, timer)).ok();
        for wheel in [&LEFT, &RIGHT] {
            wheel.levels.store(wheel.read(), Ordering::Relaxed);
        }
        for vector in [
            Vector::InputCapture1,
            Vector::InputCapture2,
            Vector::InputCapture3,
            Vector::InputCapture4,
        ] {
            interrupt::set_priority(vector, Priority::Level4, SubPriority::Sub0).ok();
        }
        for source in SOURCES {
            source.enable();
        }
        Self {
            left: PhaseOrder::from_calibration(calibration.measured(Calibrated::WheelLeftOrder)),
            right: PhaseOrder::from_calibration(calibration.measured(Calibrated::WheelRightOrder)),
            calibrated: calibration.wheels().is_some(),
        }
    }

    /// Called once a millisecond: enables lines again that were disabled for noise.
    pub fn service(&mut self) {
        for (budget, source) in RATE_LIMITS.iter().zip(SOURCES) {
            if budget.renew() {
                source.enable();
            }
        }
    }

    /// Whether distance per count and order are calibrated, so that speeds can be controlled.
    #[must_use]
    pub const fn is_calibrated(&self) -> bool {
        self.calibrated
    }
}

impl Encoders for WheelEncoders {
    const PRESENT: bool = true;

    fn counts(&mut self) -> WheelCounts {
        WheelCounts {
            left: self.left.forward(LEFT.total()),
            right: self.right.forward(RIGHT.total()),
        }
    }
}

/// Raw totals: line 1 leading is positive, without calibrated order or unit.
#[must_use]
pub(super) fn raw() -> EncoderProbe {
    EncoderProbe {
        left: LEFT.total(),
        right: RIGHT.total(),
        left_illegal: LEFT.illegal.load(Ordering::Relaxed),
        right_illegal: RIGHT.illegal.load(Ordering::Relaxed),
        brush: Some(brush_pulses()),
    }
}

/// Counts of both wheels together since the last call, in any direction: a measure of distance.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Odometer {
    left: i32,
    right: i32,
}

impl Odometer {
    pub(super) fn take(&mut self) -> u32 {
        let (left, right) = (LEFT.total(), RIGHT.total());
        let counts =
            left.wrapping_sub(self.left).unsigned_abs() + right.wrapping_sub(self.right).unsigned_abs();
        (self.left, self.right) = (left, right);
        counts
    }
}
