//! Sleeps with all clocks off until the switch on RG9 (CN11, to ground, on the chip's own pull-up) closes or opens. Each time it
//! changes the lamp on RG7 and writes to UART 1 (RF3, 115200 baud) how deep it slept and how many counts of the core timer passed.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;
mod text;

use core::fmt::Write as _;
use core::sync::atomic::{AtomicU32, Ordering};
use embedded_io::Write as _;
use pic32mx3_hal::gpio::{Level, Port};
use pic32mx3_hal::interrupt::{Context, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::{Peripherals, core_timer, entry, interrupt, power, reset};
use text::Text;

const BAUD: u32 = 115_200;
const SETTLE_COUNTS: u32 = 2 * 40_000;

static CHANGED: AtomicU32 = AtomicU32::new(0);

fn on_change(_: &mut Context<vector::CHANGE_NOTICE>) {
    let _levels = Port::G.read();
    Source::ChangeNotice.clear();
    CHANGED.store(1, Ordering::Release);
}
interrupt!(CHANGE_NOTICE, on_change);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let mut lamp = pins.rg7.into_output(Level::Low);
    let mut switch = pins.rg9.into_input();
    switch.enable_pull_up();
    // The pull-up is weak: the line needs a moment to rise.
    let begun = core_timer::count();
    while core_timer::count().wrapping_sub(begun) < SETTLE_COUNTS {}
    let uart_pins = (pins.rf3.into_output(Level::High), pins.rf2.into_input());
    let clocks = board::CONFIGURATION.clocks();
    let Ok((transmitter, _)) = peripherals.uart1.start(uart_pins, BAUD, clocks.peripheral_hz) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    let mut change_notice = peripherals.change_notice;
    switch.enable_notice();
    change_notice.start();
    let _levels = Port::G.read();
    Source::ChangeNotice.clear();
    if interrupt::set_priority(Vector::ChangeNotice, Priority::Level4, SubPriority::Sub0).is_err() {
        reset::software_reset();
    }
    Source::ChangeNotice.enable();
    interrupt::start();
    let _ = power::take_rest();
    loop {
        let fell_asleep = core_timer::count();
        while CHANGED.load(Ordering::Acquire) == 0 {
            power::sleep_while_zero(&CHANGED);
        }
        CHANGED.store(0, Ordering::Relaxed);
        let counts = core_timer::count().wrapping_sub(fell_asleep);
        lamp.toggle();
        let few = counts < SETTLE_COUNTS;
        let told = match (power::take_rest(), few) {
            (Some(rest), true) => writeln!(text, "{rest:?}, few counts"),
            (Some(rest), false) => writeln!(text, "{rest:?}, many counts"),
            (None, _) => writeln!(text, "no rest"),
        };
        told.ok();
        // Sleep would stop the UART in the midst of a byte.
        let Ok(()) = text.0.flush();
    }
}
entry!(main);
