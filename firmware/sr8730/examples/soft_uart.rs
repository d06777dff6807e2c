//! A UART on pins without one: receives on RC13 (CN1), finds the rate from the letter `U`, and sends every byte back on RB7.
//! Framing errors come back as `!`, overruns as `?`.
//!
//! Edges are noted at level 6, bits are sent by timer 4 at level 5, the main program polls once a millisecond.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

#[path = "../../pic32mx3-hal/examples/board/mod.rs"]
mod board;

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use pic32mx3_hal::core_timer::Ticker;
use pic32mx3_hal::gpio::{self, Input, NoticePin, Output, Pin, Port};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::timer::{Prescaler, Timer};
use pic32mx3_hal::{Peripherals, core_timer, cpu, entry, interrupt, reset};
use soft_uart::{
    Baud, BitTime, ByteRing, Due, Edge, EdgeRing, Level, Queued, Received, Receiver, Transmitter,
};

type ReceivePin = Pin<'C', 13, Input>;

/// Bits of the receiving pin in its port.
const RECEIVE: u16 = 1 << 13;
/// The first period of the sending timer: soon.
const SOON_COUNTS: u32 = 400;

static EDGES: EdgeRing<256> = EdgeRing::new();
static OUTGOING: ByteRing<256> = ByteRing::new();
static TICKED: AtomicU32 = AtomicU32::new(0);
static TICKER: HandlerCell<vector::CORE_TIMER, Ticker> = HandlerCell::empty();
static SENDER: HandlerCell<vector::TIMER_4, Sender> = HandlerCell::empty();
/// Whether the timer runs.
static SENDING: AtomicBool = AtomicBool::new(false);
/// Bits a second that the sender shall use from the next byte on.
static RATE: AtomicU32 = AtomicU32::new(0);

struct Sender {
    timer: Timer<4>,
    pin: Pin<'B', 7, Output>,
    transmitter: Transmitter,
    rate: u32,
    peripheral_hz: u32,
}

fn on_edge(_: &mut Context<vector::CHANGE_NOTICE>) {
    let at = core_timer::count();
    let level = Level::of_bit(u32::from(Port::C.read() & RECEIVE != 0));
    Source::ChangeNotice.clear();
    EDGES.push(Edge { at, level });
}
interrupt!(CHANGE_NOTICE, on_edge);

fn on_bit(context: &mut Context<vector::TIMER_4>) {
    let Some(sender) = SENDER.get(context) else { return };
    match sender.transmitter.due() {
        Due::Run { level, counts } => {
            sender.pin.set_level(match level {
                Level::Low => gpio::Level::Low,
                Level::High => gpio::Level::High,
            });
            sender.timer.set_period(counts);
            Source::Timer4.clear();
            sender.transmitter.prepare(|| OUTGOING.pop());
        }
        Due::Idle => {
            Source::Timer4.clear();
            begin(sender);
        }
    }
}
interrupt!(TIMER_4, on_bit);

/// Takes the next byte, or goes to sleep until the main program asks again.
fn begin(sender: &mut Sender) {
    let rate = RATE.load(Ordering::Relaxed);
    if rate != sender.rate
        && let Some(baud) = Baud::from_bits_per_second(rate)
    {
        sender.rate = rate;
        sender
            .transmitter
            .set_bit_time(BitTime::new(baud, sender.peripheral_hz));
    }
    sender.transmitter.prepare(|| OUTGOING.pop());
    match sender.transmitter.due() {
        Due::Run { .. } => {
            SENDING.store(true, Ordering::Relaxed);
            sender.timer.start(Prescaler::By1, SOON_COUNTS);
        }
        Due::Idle => {
            sender.timer.stop();
            SENDING.store(false, Ordering::Release);
        }
    }
}

fn on_tick(context: &mut Context<vector::CORE_TIMER>) {
    if let Some(ticker) = TICKER.get(context) {
        ticker.advance();
        TICKED.store(1, Ordering::Release);
    }
}
interrupt!(CORE_TIMER, on_tick);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let clocks = board::CONFIGURATION.clocks();
    let mut receive: ReceivePin = peripherals.pins.rc13.into_input();
    const {
        assert!(
            <ReceivePin as NoticePin>::NOTICE == 1,
            "the pin has change notice"
        )
    };
    receive.enable_pull_up();
    receive.enable_notice();
    let sender = Sender {
        timer: peripherals.timer4,
        pin: peripherals.pins.rb7.into_output(gpio::Level::High),
        transmitter: Transmitter::new(BitTime::new(Baud::B115200, clocks.peripheral_hz)),
        rate: 0,
        peripheral_hz: clocks.peripheral_hz,
    };
    let ticker = peripherals.core_timer.into_ticker(clocks.core_timer_hz() / 1_000);
    let ready = SENDER.hand_over(sender).is_ok()
        && TICKER.hand_over(ticker).is_ok()
        && interrupt::set_priority(Vector::ChangeNotice, Priority::Level6, SubPriority::Sub0).is_ok()
        && interrupt::set_priority(Vector::Timer4, Priority::Level5, SubPriority::Sub0).is_ok()
        && interrupt::set_priority(Vector::CoreTimer, Priority::Level2, SubPriority::Sub0).is_ok();
    if !ready {
        reset::software_reset();
    }
    let mut change_notice = peripherals.change_notice;
    change_notice.start();
    let _levels = Port::C.read();
    Source::ChangeNotice.clear();
    [Source::ChangeNotice, Source::Timer4, Source::CoreTimer]
        .into_iter()
        .for_each(Source::enable);
    interrupt::start();
    echo(Receiver::automatic(clocks.core_timer_hz()))
}
entry!(main);

fn echo(mut receiver: Receiver) -> ! {
    let mut answer = |received| {
        let byte = match received {
            Received::Byte(byte) => byte,
            Received::FramingError | Received::Break => b'!',
            Received::Overrun => b'?',
        };
        OUTGOING.push(&[byte]);
    };
    loop {
        while TICKED.load(Ordering::Acquire) == 0 {
            cpu::sleep_while_zero(&TICKED);
        }
        TICKED.store(0, Ordering::Relaxed);
        let now = core_timer::count();
        while let Some(queued) = EDGES.pop() {
            match queued {
                Queued::Edge(edge) => receiver.edge(edge, &mut answer),
                Queued::Overrun => receiver.overrun(&mut answer),
            }
        }
        receiver.poll(now, &mut answer);
        if let Some(baud) = receiver.rate() {
            RATE.store(baud.bits_per_second(), Ordering::Relaxed);
            // It checks the queue once more before it reports that it does not send, so no byte stays behind.
            if !OUTGOING.is_empty() && !SENDING.load(Ordering::Acquire) {
                Source::Timer4.request();
            }
        }
    }
}
