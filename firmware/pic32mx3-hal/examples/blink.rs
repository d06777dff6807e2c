//! A lamp on RG7 that changes every 5 ms, timed by the tick of the core timer; in between the processor sleeps.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use pic32mx3_hal::core_timer::Ticker;
use pic32mx3_hal::gpio::{Level, Output, Pin};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::{Peripherals, cpu, entry, interrupt, reset};

use core::sync::atomic::{AtomicU32, Ordering};

const TICKS_PER_S: u32 = 1_000;
const TICKS_PER_CHANGE: u32 = 5;

struct Lamp {
    ticker: Ticker,
    pin: Pin<'G', 7, Output>,
    ticks: u32,
}

static LAMP: HandlerCell<vector::CORE_TIMER, Lamp> = HandlerCell::empty();
static NEVER: AtomicU32 = AtomicU32::new(0);

fn on_tick(context: &mut Context<vector::CORE_TIMER>) {
    let Some(lamp) = LAMP.get(context) else { return };
    lamp.ticks += lamp.ticker.advance();
    if lamp.ticks >= TICKS_PER_CHANGE {
        lamp.ticks -= TICKS_PER_CHANGE;
        lamp.pin.toggle();
    }
}
interrupt!(CORE_TIMER, on_tick);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let period_counts = board::CONFIGURATION.clocks().core_timer_hz() / TICKS_PER_S;
    let lamp = Lamp {
        ticker: peripherals.core_timer.into_ticker(period_counts),
        pin: peripherals.pins.rg7.into_output(Level::Low),
        ticks: 0,
    };
    if LAMP.hand_over(lamp).is_err()
        || interrupt::set_priority(Vector::CoreTimer, Priority::Level2, SubPriority::Sub0).is_err()
    {
        reset::software_reset();
    }
    Source::CoreTimer.enable();
    interrupt::start();
    loop {
        cpu::sleep_while_zero(&NEVER);
        // The lamp needs nothing of the main program.
        NEVER.store(0, Ordering::Relaxed);
    }
}
entry!(main);
