//! Two of these chips exchange frames of 16 bits on SPI 2 (SCK RG6, SDI RG7, SDO RG8, SS RG9) at 1 MHz. The one whose RE0 is
//! high makes clock and pulses. Both send 1, 2, 3 .. and write what comes to UART 1 (RF3, 115200 baud), one number a line.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;
mod text;

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::Polarity;
use pic32mx3_hal::core_timer::Delay;
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::spi::{Follows, FramePulse, Framed, Leads, PulseLevel, PulsePlace};
use pic32mx3_hal::{Peripherals, entry, reset};
use text::Text;

const BAUD: u32 = 115_200;
const CLOCK_HZ: u32 = 1_000_000;
const PULSE: FramePulse = FramePulse {
    level: PulseLevel::High,
    place: PulsePlace::BeforeFirstBit,
};

/// Sends and tells, for ever; one that leads gives the other time to have its word ready.
fn exchange<P>(mut framed: Framed<2, u16, P>, mut text: impl core::fmt::Write, delay: Option<Delay>) -> ! {
    let mut delay = delay;
    let mut number = 0_u16;
    loop {
        if let Some(delay) = &mut delay {
            delay.delay_ms(1);
        }
        number = number.wrapping_add(1);
        while !framed.try_send(number) {}
        let received = loop {
            if let Some(received) = framed.try_receive() {
                break received;
            }
        };
        match received {
            Ok(word) => writeln!(text, "{word}").ok(),
            Err(error) => writeln!(text, "{error}").ok(),
        };
    }
}

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let leads = pins.re0.into_input().is_high();
    let (data_out, data_in) = (pins.rg8.into_output(Level::Low), pins.rg7.into_input());
    let uart_pins = (pins.rf3.into_output(Level::High), pins.rf2.into_input());
    let clocks = board::CONFIGURATION.clocks();
    let Ok((transmitter, _)) = peripherals.uart1.start(uart_pins, BAUD, clocks.peripheral_hz) else {
        reset::software_reset()
    };
    let text = Text(transmitter);
    if leads {
        let clock = Leads(pins.rg6.into_output(Level::Low));
        let pulse = Leads(pins.rg9.into_output(Level::Low));
        let all = (clock, data_out, data_in, pulse);
        let mut framed = peripherals
            .spi2
            .into_framed::<u16, _, _, _, _>(all, Polarity::IdleLow, PULSE);
        if framed.set_frequency(CLOCK_HZ, clocks.peripheral_hz).is_err() {
            reset::software_reset();
        }
        exchange(framed, text, Some(Delay::new(clocks)))
    } else {
        let clock = Follows(pins.rg6.into_input());
        let pulse = Follows(pins.rg9.into_input());
        let all = (clock, data_out, data_in, pulse);
        let framed = peripherals
            .spi2
            .into_framed::<u16, _, _, _, _>(all, Polarity::IdleLow, PULSE);
        exchange(framed, text, None)
    }
}
entry!(main);
