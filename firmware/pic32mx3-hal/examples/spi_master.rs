//! A master on SPI 2 (SCK RG6, SDI RG7, SDO RG8), mode 0 at 1 MHz, with a device that RG9 selects: every millisecond it sends a
//! command and three more bytes, and writes what comes back to UART 1 (RF3, 115200 baud): `00 9F 01 02`.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;
mod text;

use core::fmt::Write as _;
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{MODE_0, SpiBus};
use pic32mx3_hal::core_timer::Delay;
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::{Peripherals, entry, reset};
use text::Text;

const BAUD: u32 = 115_200;
const CLOCK_HZ: u32 = 1_000_000;
const COMMAND: u8 = 0x9F;
/// The device needs time to see that it is selected, and to have an answer ready.
const SETTLE_US: u32 = 20;

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
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
    let Ok(mut spi) = peripherals.spi2.into_master::<u8, _, _, _>(spi_pins, MODE_0, hz) else {
        reset::software_reset()
    };
    let Ok((transmitter, _)) = peripherals.uart1.start(uart_pins, BAUD, hz.1) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    let mut delay = Delay::new(clocks);
    loop {
        delay.delay_ms(1);
        let mut words = [COMMAND, 1, 2, 3];
        select.set_low();
        delay.delay_us(SETTLE_US);
        let mut result = Ok(());
        for word in &mut words {
            result = result.and(spi.transfer_in_place(core::slice::from_mut(word)));
            delay.delay_us(SETTLE_US);
        }
        select.set_high();
        let [first, second, third, fourth] = words;
        match result {
            Ok(()) => writeln!(text, "{first:02X} {second:02X} {third:02X} {fourth:02X}").ok(),
            Err(error) => writeln!(text, "{error}").ok(),
        };
    }
}
entry!(main);
