//! Timer 3 has AN2 sampled 50,000 times a second, and DMA collects 64 samples while the processor idles. Their least, mean and greatest go to UART 2
//! (RF5, 115200 baud), every hundredth time.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;
mod text;

use core::fmt::Write as _;
use core::sync::atomic::{AtomicU32, Ordering};
use pic32mx3_hal::adc::Timing;
use pic32mx3_hal::dma::{Channel, SampleTrigger, StaticBuffer};
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::interrupt::{Context, Priority, SubPriority, Vector, vector};
use pic32mx3_hal::timer::Prescaler;
use pic32mx3_hal::{Peripherals, cpu, entry, interrupt, reset};
use text::Text;

const BAUD: u32 = 115_200;
const SAMPLES_HZ: u32 = 50_000;
const INPUT: u8 = 2;
/// Told once in so many blocks.
const TOLD: u32 = 100;
/// 400 ns clocks; the timer says how long is sampled.
const TIMING: Timing = Timing {
    clock_divider: 15,
    sample_clocks: 31,
};
static SAMPLES: StaticBuffer<u32, 64> = StaticBuffer::new([0; 64]);
static OVER: AtomicU32 = AtomicU32::new(0);

fn on_block(_: &mut Context<vector::DMA_0>) {
    Channel::<0>::acknowledge();
    OVER.store(1, Ordering::Release);
}
interrupt!(DMA_0, on_block);

fn main() -> ! {
    let Some(mut peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let Some(mut samples) = SAMPLES.take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let _an2 = pins.rb2.into_analog();
    let uart_pins = (pins.rf5.into_output(Level::High), pins.rf4.into_input());
    let clocks = board::CONFIGURATION.clocks();
    let Ok((transmitter, _)) = peripherals.uart2.start(uart_pins, BAUD, clocks.peripheral_hz) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    peripherals
        .timer3
        .start(Prescaler::By1, clocks.peripheral_hz / SAMPLES_HZ);
    let (mut scanner, mut results) = peripherals.adc.start(TIMING);
    let mut channel = peripherals.dma.start().channel0;
    if interrupt::set_priority(Vector::Dma0, Priority::Level3, SubPriority::Sub0).is_err() {
        reset::software_reset();
    }
    Channel::<0>::SOURCE.enable();
    interrupt::start();

    let mut blocks = 0_u32;
    loop {
        OVER.store(0, Ordering::Relaxed);
        let how = (INPUT, SampleTrigger::Timer3);
        let Ok(sampling) = scanner.sample_by_dma(results, (channel, samples), how) else {
            reset::software_reset()
        };
        while OVER.load(Ordering::Acquire) == 0 {
            cpu::sleep_while_zero(&OVER);
        }
        let sampled = sampling.wait();
        (channel, samples) = (sampled.channel, sampled.buffer);
        (scanner, results) = (sampled.driver.scanner, sampled.driver.results);
        blocks += 1;
        if blocks % TOLD == 1 {
            let least = samples.iter().min().copied().unwrap_or(0);
            let greatest = samples.iter().max().copied().unwrap_or(0);
            let mean = samples.iter().sum::<u32>() / samples.len() as u32;
            writeln!(text, "{least} {mean} {greatest}").ok();
        }
    }
}
entry!(main);
