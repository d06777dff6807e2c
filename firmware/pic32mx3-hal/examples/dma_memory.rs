//! A channel copies, fills, is stopped midway, and copies a text up to its end, while the program does something else; another one feeds the CRC unit. What came of it goes to
//! UART 1 (RF3, 115200 baud).
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;
mod text;

use core::fmt::Write;
use core::sync::atomic::AtomicU32;
use pic32mx3_hal::dma::{Channel, CrcSettings, CrcUnit, StaticBuffer};
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::{Peripherals, cpu, entry, reset};
use text::Text;

const BAUD: u32 = 115_200;
/// In flash.
static TABLE: [u32; 64] = {
    let mut table = [0; 64];
    let mut index = 0;
    while index < table.len() {
        table[index] = (index * index) as u32;
        index += 1;
    }
    table
};
static COPY: StaticBuffer<u32, 64> = StaticBuffer::new([0; 64]);
static LINE: StaticBuffer<u8, 32> = StaticBuffer::new([b'.'; 32]);
static NEVER: AtomicU32 = AtomicU32::new(0);
const XMODEM: CrcSettings = CrcSettings {
    polynomial: 0x1021,
    bits: 16,
    initial: 0,
};

/// A copy that is stopped: what was moved is there, and the rest is as it was.
fn stop_midway<W: Write>(
    text: &mut W,
    channel: Channel<0>,
    buffer: &'static mut [u32; 64],
) -> Option<Channel<0>> {
    buffer.fill(0);
    let copying = channel.copy(&TABLE, buffer).ok()?;
    while copying.progress() < 3 {}
    let stopped = copying.stop();
    let moved = stopped.moved;
    let is_right = stopped
        .buffer
        .iter()
        .zip(&TABLE)
        .enumerate()
        .all(|(index, (copy, word))| *copy == if index < moved { *word } else { 0 });
    writeln!(text, "stopped midway: {}, {is_right}", (3..64).contains(&moved)).ok()?;
    Some(stopped.channel)
}

/// The CRC of a message in two parts.
fn sum_up<W: Write>(text: &mut W, channel: Channel<3>, mut unit: CrcUnit) -> Option<()> {
    unit.begin(XMODEM).ok()?;
    let fed = channel.feed_crc(unit, b"1234").ok()?.wait();
    let fed = fed.channel.feed_crc(fed.driver, b"56789").ok()?.wait();
    writeln!(text, "crc {:04x} {:?}", fed.driver.result(), fed.outcome).ok()
}

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let (Some(copy), Some(line)) = (COPY.take(), LINE.take()) else {
        reset::software_reset()
    };
    let pins = (
        peripherals.pins.rf3.into_output(Level::High),
        peripherals.pins.rf2.into_input(),
    );
    let hz = board::CONFIGURATION.clocks().peripheral_hz;
    let Ok((transmitter, _)) = peripherals.uart1.start(pins, BAUD, hz) else {
        reset::software_reset()
    };
    let mut text = Text(transmitter);
    let channels = peripherals.dma.start();

    let Ok(copying) = channels.channel0.copy(&TABLE, copy) else {
        reset::software_reset()
    };
    let mut rounds = 0_u32;
    while !copying.is_over() {
        rounds += 1;
    }
    let copied = copying.wait();
    let same = copied.buffer == &TABLE;
    writeln!(
        text,
        "copied {} words, same: {same}, waited: {}",
        copied.moved,
        rounds > 0
    )
    .ok();

    let Ok(filling) = copied.channel.copy(&[0xDEAD_BEEF_u32], copied.buffer) else {
        reset::software_reset()
    };
    let filled = filling.wait();
    let full = filled.buffer.iter().all(|word| *word == 0xDEAD_BEEF);
    writeln!(text, "filled {} words: {full}", filled.moved).ok();

    let Some(channel) = stop_midway(&mut text, filled.channel, filled.buffer) else {
        reset::software_reset()
    };
    let Ok(copying) = channel.copy_until(b"up to its end\0and no further", line, 0) else {
        reset::software_reset()
    };
    let copied = copying.wait();
    let (told, rest) = copied.buffer.split_at(copied.moved);
    let told = told
        .strip_suffix(&[0])
        .and_then(|bytes| core::str::from_utf8(bytes).ok());
    writeln!(
        text,
        "{} and {}",
        told.unwrap_or("?"),
        core::str::from_utf8(rest).unwrap_or("?")
    )
    .ok();

    if sum_up(&mut text, channels.channel3, channels.crc).is_none() {
        reset::software_reset();
    }
    loop {
        cpu::sleep_while_zero(&NEVER);
    }
}
entry!(main);
