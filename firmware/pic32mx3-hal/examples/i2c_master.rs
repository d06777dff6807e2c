//! A master on I2C 1 (SDA RG3, SCL RG2), 400 kHz, with a memory at address 0x50: it writes four bytes at place 2, reads them
//! back, then asks an address that nobody has, and writes what came of it to UART 1 (RF3, 115200 baud), each 2 ms.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;
mod text;

use core::fmt::Write as _;
use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;
use pic32mx3_hal::core_timer::Delay;
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::i2c::Speed;
use pic32mx3_hal::{Peripherals, entry, reset};
use text::Text;

const BAUD: u32 = 115_200;
const MEMORY: u8 = 0x50;
const NOBODY: u8 = 0x31;
const PLACE: u8 = 2;

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let lines = (pins.rg3.into_input(), pins.rg2.into_input());
    let uart_pins = (pins.rf3.into_output(Level::High), pins.rf2.into_input());
    let clocks = board::CONFIGURATION.clocks();
    // 10 ms for each step.
    let patience = clocks.core_timer_hz() / 100;
    let speed = (Speed::Fast, clocks.peripheral_hz);
    let Ok(mut i2c) = peripherals.i2c1.into_master(lines, speed, patience) else {
        reset::software_reset()
    };
    let Ok((transmitter, _)) = peripherals.uart1.start(uart_pins, BAUD, clocks.peripheral_hz) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    let mut delay = Delay::new(clocks);
    let mut round = 0_u8;
    loop {
        delay.delay_ms(2);
        round = round.wrapping_add(1);
        let written = i2c.write(MEMORY, &[PLACE, round, 0xA5, 0x00, 0xFF]);
        let mut read = [0; 4];
        let came = i2c.write_read(MEMORY, &[PLACE], &mut read);
        let [first, second, third, fourth] = read;
        match written.and(came) {
            Ok(()) => writeln!(text, "{first} {second:02X} {third:02X} {fourth:02X}").ok(),
            Err(error) => {
                i2c.recover(clocks.core_timer_hz() / 200_000);
                writeln!(text, "memory: {error}").ok()
            }
        };
        if let Err(error) = i2c.read(NOBODY, &mut read) {
            writeln!(text, "nobody: {error}").ok();
        }
    }
}
entry!(main);
