//! Measures the signal on RD8 (IC1): timer 2 gives the times of the input capture, timers 4 and 5 together count
//! with 32 bits. Each rising edge gives a line on UART 1 (RF3, 115200 baud) with the time since the previous edge, in both ways
//! equal as long as it is below 52 ms: `1250 1250`. A falling edge on RE8 (INT1) gives `x`.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use core::fmt::Write as _;
use core::sync::atomic::{AtomicU32, Ordering};
use embedded_io::Write;
use pic32mx3_hal::capture::{Capture, CaptureEdge, CaptureTimer};
use pic32mx3_hal::external::{Edge, ExternalPin};
use pic32mx3_hal::gpio::{Input, Level, Pin};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::timer::{LongTimer, Prescaler};
use pic32mx3_hal::{Peripherals, cpu, entry, interrupt, reset};

struct Meter {
    capture: Capture<1, Pin<'D', 8, Input>>,
    long: LongTimer<4>,
    last: u16,
    last_long: u32,
}

static METER: HandlerCell<vector::INPUT_CAPTURE_1, Meter> = HandlerCell::empty();
static SHORT_COUNTS: AtomicU32 = AtomicU32::new(0);
static LONG_COUNTS: AtomicU32 = AtomicU32::new(0);
static EDGES: AtomicU32 = AtomicU32::new(0);
const CAPTURED: u32 = 1;
const INTERRUPTED: u32 = 2;

fn on_capture(context: &mut Context<vector::INPUT_CAPTURE_1>) {
    let Some(meter) = METER.get(context) else { return };
    let now = meter.long.count();
    while let Some(count) = meter.capture.take() {
        SHORT_COUNTS.store(u32::from(count.wrapping_sub(meter.last)), Ordering::Relaxed);
        meter.last = count;
    }
    LONG_COUNTS.store(now.wrapping_sub(meter.last_long), Ordering::Relaxed);
    meter.last_long = now;
    Source::InputCapture1.clear();
    EDGES.store(EDGES.load(Ordering::Relaxed) | CAPTURED, Ordering::Release);
}
interrupt!(INPUT_CAPTURE_1, on_capture);

fn on_external(_: &mut Context<vector::EXTERNAL_1>) {
    Source::External1.clear();
    EDGES.store(EDGES.load(Ordering::Relaxed) | INTERRUPTED, Ordering::Release);
}
interrupt!(EXTERNAL_1, on_external);

/// Lets `write!` write to a UART.
struct Text<W>(W);

impl<W: Write> core::fmt::Write for Text<W> {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        self.0.write_all(text.as_bytes()).map_err(|_| core::fmt::Error)
    }
}

fn main() -> ! {
    let Some(mut peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let clocks = board::CONFIGURATION.clocks();
    let uart_pins = (pins.rf3.into_output(Level::High), pins.rf2.into_input());
    let Ok((transmitter, _)) = peripherals.uart1.start(uart_pins, 115_200, clocks.peripheral_hz) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    // 0.8 us a count; the first timer turns over every 52 ms.
    peripherals.timer2.start(Prescaler::By64, 0x1_0000);
    let mut long = LongTimer::<4>::new(peripherals.timer4, peripherals.timer5);
    long.start(Prescaler::By64, u32::MAX);
    let capture =
        peripherals
            .capture1
            .start(pins.rd8.into_input(), CaptureEdge::Rising, CaptureTimer::Timer2);
    let meter = Meter {
        capture,
        long,
        last: 0,
        last_long: 0,
    };
    let mut external = pins.re8.into_input();
    external.select_edge(Edge::Falling);
    let ready = METER.hand_over(meter).is_ok()
        && interrupt::set_priority(Vector::InputCapture1, Priority::Level4, SubPriority::Sub0).is_ok()
        && interrupt::set_priority(Vector::External1, Priority::Level4, SubPriority::Sub1).is_ok();
    if !ready {
        reset::software_reset();
    }
    Source::InputCapture1.enable();
    Source::External1.enable();
    interrupt::start();
    loop {
        cpu::sleep_while_zero(&EDGES);
        let edges = interrupt::free(|| {
            let edges = EDGES.load(Ordering::Acquire);
            EDGES.store(0, Ordering::Relaxed);
            edges
        });
        if edges & CAPTURED != 0 {
            // A count is 0.8 us.
            let us = |counts: &AtomicU32| counts.load(Ordering::Relaxed) * 4 / 5;
            writeln!(text, "{} {}", us(&SHORT_COUNTS), us(&LONG_COUNTS)).ok();
        }
        if edges & INTERRUPTED != 0 {
            writeln!(text, "x").ok();
        }
    }
}
entry!(main);
