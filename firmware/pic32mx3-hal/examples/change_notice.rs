//! A switch on RG9 (CN11) to ground, held high by the chip's own pull-up: each time it closes, the lamp on RG7 changes. A
//! switch that bounces counts once: 2 ms after a change it is read again.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use core::sync::atomic::{AtomicU32, Ordering};
use pic32mx3_hal::gpio::{Level, Port};
use pic32mx3_hal::interrupt::{Context, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::{Peripherals, core_timer, cpu, entry, interrupt, reset};

const SETTLE_COUNTS: u32 = 2 * 40_000;

static CHANGED: AtomicU32 = AtomicU32::new(0);

fn on_change(_: &mut Context<vector::CHANGE_NOTICE>) {
    // Reading the port makes this level the reference of the chip; only then can the request be cleared.
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
    let mut change_notice = peripherals.change_notice;
    switch.enable_notice();
    change_notice.start();
    let mut closed = switch.is_low();
    Source::ChangeNotice.clear();
    if interrupt::set_priority(Vector::ChangeNotice, Priority::Level4, SubPriority::Sub0).is_err() {
        reset::software_reset();
    }
    Source::ChangeNotice.enable();
    interrupt::start();
    loop {
        while CHANGED.load(Ordering::Acquire) == 0 {
            cpu::sleep_while_zero(&CHANGED);
        }
        let begun = core_timer::count();
        while core_timer::count().wrapping_sub(begun) < SETTLE_COUNTS {}
        CHANGED.store(0, Ordering::Relaxed);
        let is_closed = switch.is_low();
        if is_closed && !closed {
            lamp.toggle();
        }
        closed = is_closed;
    }
}
entry!(main);
