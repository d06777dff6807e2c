//! What comes in on UART 1 (RF2) goes out again (RF3), 115200 baud. After a framing error a `!` goes out, after an overrun
//! a `?`.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use embedded_io::{Read, Write};
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::uart::Error;
use pic32mx3_hal::{Peripherals, entry, reset};

const BAUD: u32 = 115_200;

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = (
        peripherals.pins.rf3.into_output(Level::High),
        peripherals.pins.rf2.into_input(),
    );
    let clocks = board::CONFIGURATION.clocks();
    let Ok((mut transmitter, mut receiver)) = peripherals.uart1.start(pins, BAUD, clocks.peripheral_hz)
    else {
        reset::software_reset()
    };
    let mut buffer = [0; 16];
    loop {
        let answer = match receiver.read(&mut buffer) {
            Ok(count) => buffer.get(..count).unwrap_or_default(),
            Err(Error::Framing | Error::Parity) => b"!",
            Err(Error::Overrun) => b"?",
        };
        let Ok(()) = transmitter.write_all(answer);
    }
}
entry!(main);
