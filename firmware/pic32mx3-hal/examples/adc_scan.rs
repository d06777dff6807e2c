//! Scans AN2, AN3 and AN12 every millisecond and writes the counts to UART 2 (RF5, 115200 baud): `2=17 3=1023 12=500`.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;
mod text;

use core::fmt::Write as _;
use core::sync::atomic::{AtomicU32, Ordering};
use pic32mx3_hal::adc::{Channels, Results, Timing};
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::{Peripherals, core_timer, cpu, entry, interrupt, reset};
use text::Text;

const BAUD: u32 = 115_200;
const CHANNELS: Channels = Channels::NONE.with(2).with(3).with(12);
/// 400 ns clocks; 31 of them for sampling, which is enough for 100 kiloohms or so.
const TIMING: Timing = Timing {
    clock_divider: 15,
    sample_clocks: 31,
};

static RESULTS: HandlerCell<vector::ADC, Results> = HandlerCell::empty();
/// One more than the result of each channel, 0 while there is none.
static NEWEST: [AtomicU32; 3] = [const { AtomicU32::new(0) }; 3];
static FRESH: AtomicU32 = AtomicU32::new(0);

fn on_scan(context: &mut Context<vector::ADC>) {
    if let Some(results) = RESULTS.get(context) {
        for (position, newest) in (0..).zip(&NEWEST) {
            newest.store(u32::from(results.get(position)), Ordering::Relaxed);
        }
        FRESH.store(1, Ordering::Release);
    }
    Source::Adc.clear();
}
interrupt!(ADC, on_scan);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let (_an2, _an3, _an12) = (
        pins.rb2.into_analog(),
        pins.rb3.into_analog(),
        pins.rb12.into_analog(),
    );
    let uart_pins = (pins.rf5.into_output(Level::High), pins.rf4.into_input());
    let clocks = board::CONFIGURATION.clocks();
    let Ok((transmitter, _)) = peripherals.uart2.start(uart_pins, BAUD, clocks.peripheral_hz) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    let (mut scanner, results) = peripherals.adc.start(TIMING);
    if RESULTS.hand_over(results).is_err()
        || interrupt::set_priority(Vector::Adc, Priority::Level3, SubPriority::Sub0).is_err()
    {
        reset::software_reset();
    }
    Source::Adc.enable();
    interrupt::start();

    let period_counts = clocks.core_timer_hz() / 1_000;
    let mut next = core_timer::count();
    loop {
        next = next.wrapping_add(period_counts);
        scanner.start(CHANNELS);
        while FRESH.load(Ordering::Acquire) == 0 {
            cpu::sleep_while_zero(&FRESH);
        }
        FRESH.store(0, Ordering::Relaxed);
        let [an2, an3, an12] = [0, 1, 2].map(|index: usize| {
            NEWEST
                .get(index)
                .map_or(0, |newest| newest.load(Ordering::Relaxed))
        });
        writeln!(text, "2={an2} 3={an3} 12={an12}").ok();
        while (core_timer::count().wrapping_sub(next) as i32) < 0 {}
    }
}
entry!(main);
