//! Tests every word of RAM in place while an interrupt of level 5 comes every 12.5 us and uses memory, too, and calculates the
//! CRC-32C of its own image. Says on UART 1 (RF3, 115200 baud): words tested, words found bad, bytes and CRC of the program and
//! of boot flash, check words, most bytes of stack used.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use core::fmt::Write as _;
use embedded_io::Write;
use pic32mx3_hal::gpio::{Level, Port};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::timer::Prescaler;
use pic32mx3_hal::{Peripherals, entry, image_crc, interrupt, memory, reset, stack};

image_crc!([0x5EA1_5EA1, 0xFFFF_FFFF]);

static TABLE: HandlerCell<vector::TIMER_2, [u32; 32]> = HandlerCell::empty();

/// Each word of the table goes through the same changes, so all are equal unless other code wrote there.
fn on_timer(context: &mut Context<vector::TIMER_2>) {
    if let Some(table) = TABLE.get(context) {
        let [first, ..] = *table;
        if table.iter().any(|word| *word != first) {
            Port::G.set(1 << 8);
        }
        for word in table {
            *word = word.wrapping_mul(3).wrapping_add(1);
        }
    }
    Source::Timer2.clear();
}
interrupt!(TIMER_2, on_timer);

fn crc_32c(bytes: &[u8]) -> u32 {
    let crc = bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0x82F6_3B78 & (crc & 1).wrapping_neg())
        })
    });
    !crc
}

/// Lets `write!` write to a UART.
struct Text<W>(W);

impl<W: Write> core::fmt::Write for Text<W> {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        self.0.write_all(text.as_bytes()).map_err(|_| core::fmt::Error)
    }
}

fn main() -> ! {
    let Some(mut peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let _bad = pins.rg8.into_output(Level::Low);
    let clocks = board::CONFIGURATION.clocks();
    let uart_pins = (pins.rf3.into_output(Level::High), pins.rf2.into_input());
    let Ok((transmitter, _)) = peripherals.uart1.start(uart_pins, 115_200, clocks.peripheral_hz) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    if TABLE.hand_over([7; 32]).is_err()
        || interrupt::set_priority(Vector::Timer2, Priority::Level5, SubPriority::Sub0).is_err()
    {
        reset::software_reset();
    }
    peripherals.timer2.start(Prescaler::By1, 1_000);
    Source::Timer2.enable();
    interrupt::start();

    let (mut tested, mut bad) = (0_u32, 0_u32);
    let mut offset = 0;
    while let Some(good) = memory::test_ram_word(offset) {
        tested += 1;
        bad += u32::from(!good);
        offset += 4;
    }
    let (program, boot) = (memory::image::program(), memory::image::boot());
    write!(text, "{tested} {bad} {} {:08x} ", program.len(), crc_32c(program)).ok();
    write!(text, "{} {:08x} ", boot.len(), crc_32c(boot)).ok();
    for word in memory::image::check_words() {
        write!(text, "{word:08x} ").ok();
    }
    writeln!(text, "{}", stack::used_most()).ok();
    loop {
        core::hint::spin_loop();
    }
}
entry!(main);
