//! Registers as plain memory, for machines that are no MIPS: nothing happens but that bits are kept, cleared, set and
//! inverted. Registers beside each other in a block are 16 bytes apart, so the low address bits select the access.

use core::sync::atomic::{AtomicU32, Ordering};

/// From the first peripheral (watchdog) to the last (port G).
const BASE: u32 = 0xBF80_0000;
const BYTES: usize = 0x9_0000;

static REGISTERS: [AtomicU32; BYTES / 16] = [const { AtomicU32::new(0) }; BYTES / 16];

fn cell(address: u32) -> Option<&'static AtomicU32> {
    REGISTERS.get((address.wrapping_sub(BASE) / 16) as usize)
}

pub(super) fn load(address: u32) -> u32 {
    cell(address).map_or(0, |cell| cell.load(Ordering::SeqCst))
}

pub(super) fn store(address: u32, value: u32) {
    let Some(cell) = cell(address) else { return };
    match address % 16 {
        super::CLEAR => cell.fetch_and(!value, Ordering::SeqCst),
        super::SET => cell.fetch_or(value, Ordering::SeqCst),
        super::INVERT => cell.fetch_xor(value, Ordering::SeqCst),
        _ => cell.swap(value, Ordering::SeqCst),
    };
}
