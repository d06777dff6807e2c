//! A master on SPI 2 (SCK RG6, SDI RG7, SDO RG8), mode 0 at 10 MHz, with a device that RG9 selects: every two milliseconds it exchanges 16
//! words of 8 bits by DMA, and the processor idles meanwhile. What came is written to UART 1 (RF3, 115200 baud).
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;
mod text;

use core::fmt::Write as _;
use core::sync::atomic::{AtomicU32, Ordering};
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::MODE_0;
use pic32mx3_hal::core_timer::Delay;
use pic32mx3_hal::dma::{Channel, StaticBuffer};
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::interrupt::{Context, Priority, SubPriority, Vector, vector};
use pic32mx3_hal::{Peripherals, cpu, entry, interrupt, reset};
use text::Text;

const BAUD: u32 = 115_200;
const CLOCK_HZ: u32 = 10_000_000;
static WORDS: StaticBuffer<u8, 16> = StaticBuffer::new([0; 16]);
static OVER: AtomicU32 = AtomicU32::new(0);

fn on_block(_: &mut Context<vector::DMA_2>) {
    Channel::<2>::acknowledge();
    OVER.store(1, Ordering::Release);
}
interrupt!(DMA_2, on_block);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let Some(mut words) = WORDS.take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let mut select = pins.rg9.into_output(Level::High);
    let spi_pins = (
        pins.rg6.into_output(Level::Low),
        pins.rg8.into_output(Level::Low),
        pins.rg7.into_input(),
    );
    let uart_pins = (pins.rf3.into_output(Level::High), pins.rf2.into_input());
    let clocks = board::CONFIGURATION.clocks();
    let hz = (CLOCK_HZ, clocks.peripheral_hz);
    let Ok(mut master) = peripherals.spi2.into_master::<u8, _, _, _>(spi_pins, MODE_0, hz) else {
        reset::software_reset()
    };
    let Ok((transmitter, _)) = peripherals.uart1.start(uart_pins, BAUD, hz.1) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    let mut delay = Delay::new(clocks);
    let channels = peripherals.dma.start();
    let mut channels = (channels.channel2, channels.channel3);
    if interrupt::set_priority(Vector::Dma2, Priority::Level3, SubPriority::Sub0).is_err() {
        reset::software_reset();
    }
    Channel::<2>::SOURCE.enable();
    interrupt::start();

    let mut round = 0_u8;
    loop {
        delay.delay_ms(2);
        for (word, place) in words.iter_mut().zip(0_u8..) {
            *word = round.wrapping_add(place);
        }
        round = round.wrapping_add(1);
        OVER.store(0, Ordering::Relaxed);
        select.set_low();
        let Ok(exchange) = master.exchange_by_dma(channels, words) else {
            reset::software_reset()
        };
        while OVER.load(Ordering::Acquire) == 0 {
            cpu::sleep_while_zero(&OVER);
        }
        let exchanged = exchange.wait();
        select.set_high();
        (master, channels, words) = (exchanged.master, exchanged.channels, exchanged.buffer);
        for word in words.iter() {
            write!(text, "{word:02X}").ok();
        }
        match exchanged.outcome {
            Ok(()) => writeln!(text).ok(),
            Err(error) => writeln!(text, " {error}").ok(),
        };
    }
}
entry!(main);
