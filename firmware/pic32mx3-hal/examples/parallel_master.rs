//! A master of the parallel port: PMD0 to PMD7 (RE0 to RE7), PMRD (RD5) and PMWR (RD4), active low, PMCS1 (RD11). Every millisecond it writes a byte to a
//! slave, reads one back, and writes both to UART 1 (RF3, 115200 baud): `5A A5`.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;
mod text;

use core::fmt::Write as _;
use embedded_hal::delay::DelayNs;
use pic32mx3_hal::core_timer::Delay;
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::parallel_port::{
    ActiveLevel, AddressLines, Increment, MasterSettings, Strobes, WaitClocks,
};
use pic32mx3_hal::{Peripherals, entry, reset};
use text::Text;

const BAUD: u32 = 115_200;
const SELECTED: u16 = 1 << 14;
/// The slave needs time to take the byte and to put its answer there.
const ANSWER_US: u32 = 20;
const SETTINGS: MasterSettings = MasterSettings {
    strobes: Strobes::Separate {
        read: ActiveLevel::Low,
        write: ActiveLevel::Low,
    },
    waits: WaitClocks {
        setup: 4,
        strobe: 16,
        hold: 4,
    },
    increment: Increment::None,
};

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let data = (
        pins.re0.into_input(),
        pins.re1.into_input(),
        pins.re2.into_input(),
        pins.re3.into_input(),
        pins.re4.into_input(),
        pins.re5.into_input(),
        pins.re6.into_input(),
        pins.re7.into_input(),
    );
    let strobes = (
        pins.rd5.into_output(Level::High),
        pins.rd4.into_output(Level::High),
    );
    let lines = AddressLines::none().with_select_1(pins.rd11.into_output(Level::High), ActiveLevel::Low);
    let uart_pins = (pins.rf3.into_output(Level::High), pins.rf2.into_input());
    let clocks = board::CONFIGURATION.clocks();
    let Ok((transmitter, _)) = peripherals.uart1.start(uart_pins, BAUD, clocks.peripheral_hz) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    let mut delay = Delay::new(clocks);
    let mut master = peripherals
        .parallel_port
        .into_master::<u8, _>((data, strobes), lines, SETTINGS);
    master.set_address(SELECTED);
    let mut byte = 0x5A_u8;
    loop {
        delay.delay_ms(1);
        master.write(byte);
        delay.delay_us(ANSWER_US);
        let answer = master.read();
        writeln!(text, "{byte:02X} {answer:02X}").ok();
        byte = byte.wrapping_mul(5).wrapping_add(1);
    }
}
entry!(main);
