//! Counts its starts in the data page: one erased word becomes a mark at each start; when the page is full, it is erased.
//! Then as many pulses on RG7 as there are marks, and a reset by software.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use pic32mx3_hal::flash::PAGE_BYTES;
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::{Peripherals, entry, reset};

const MARK: u32 = 0x4D41_524B;
const ERASED: u32 = u32::MAX;

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let mut lamp = peripherals.pins.rg7.into_output(Level::Low);
    let mut flash = peripherals.data_flash;
    let marks = (0..PAGE_BYTES / 4)
        .take_while(|index| flash.word(index * 4) == Some(MARK))
        .count() as u32;
    let written = match flash.word(marks * 4) {
        Some(ERASED) => flash.program_word(marks * 4, MARK),
        _ => flash.erase_page(0).and_then(|()| flash.program_word(0, MARK)),
    };
    if written.is_ok() {
        for _ in 0..=marks {
            lamp.set_high();
            lamp.set_low();
        }
    }
    reset::software_reset()
}
entry!(main);
