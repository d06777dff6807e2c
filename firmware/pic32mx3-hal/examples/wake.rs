//! Timer 2 sets a word and RG7; the main program sleeps until the word is set and clears both. Between two sleeps it works
//! for a time that differs each time, so that the interrupt hits every instruction on the path into sleep. RG7 is never
//! high for long: no wake-up is lost.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use core::hint::black_box;
use core::sync::atomic::{AtomicU32, Ordering};
use pic32mx3_hal::gpio::Port;
use pic32mx3_hal::interrupt::{Context, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::timer::Prescaler;
use pic32mx3_hal::{Peripherals, core_timer, cpu, entry, interrupt, reset};

const LAMP: u16 = 1 << 7;

static WORD: AtomicU32 = AtomicU32::new(0);

fn on_timer(_: &mut Context<vector::TIMER_2>) {
    WORD.store(1, Ordering::Release);
    Port::G.set(LAMP);
    Source::Timer2.clear();
}
interrupt!(TIMER_2, on_timer);

fn main() -> ! {
    let Some(mut peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    Port::G.drive(LAMP);
    if interrupt::set_priority(Vector::Timer2, Priority::Level2, SubPriority::Sub0).is_err() {
        reset::software_reset();
    }
    peripherals.timer2.start(Prescaler::By1, 4_000);
    Source::Timer2.enable();
    interrupt::start();
    let mut random = 1_u32;
    loop {
        while WORD.load(Ordering::Acquire) == 0 {
            cpu::sleep_while_zero(&WORD);
        }
        WORD.store(0, Ordering::Relaxed);
        Port::G.clear(LAMP);
        let begun = core_timer::count();
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let work_counts = 1_850 + (random >> 16) % 140;
        while core_timer::count().wrapping_sub(begun) < work_counts {}
        // Single cycles, which the loop above is too coarse for.
        for _ in 0..(random >> 8) % 8 {
            black_box(());
        }
    }
}
entry!(main);
