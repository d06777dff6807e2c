//! Data flash, which a program reads, erases and writes through the registers ISP_*.
//!
//! It begins at 0x8000. Its size, 30,720 bytes, is what a programmer's table says; a library for the part ends at
//! 0xF3FF, 1,024 bytes earlier. While an operation takes its time the core stands still. The times are those of the
//! STC89 by general knowledge, in machine cycles, and no source for this part was found.

use crate::peripheral::record::Misuse;
use crate::peripheral::register::{ISP_ADDRH, ISP_ADDRL, ISP_CMD, ISP_CONTR, ISP_DATA, ISP_TRIG};

/// First address.
pub const DATA_START: u16 = 0x8000;
/// How many bytes.
pub const DATA_BYTES: usize = 30_720;
/// How many are erased at once.
const SECTOR_BYTES: usize = 512;

/// ISP_CONTR.
const ENABLE: u8 = 0x80;
const LOADER: u8 = 0x40;
const RESET: u8 = 0x20;
const WAIT: u8 = 0x07;
/// What ISP_TRIG must be written to begin.
const TRIGGER: [u8; 2] = [0x46, 0xB9];

/// What a read, a write and an erasure take, by ISP_CONTR's waiting time.
const CYCLES: [[u64; 3]; 4] = [
    [43, 240, 43_769],
    [22, 120, 21_885],
    [11, 60, 10_942],
    [6, 30, 5_471],
];

/// What writing a register asks of the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FlashOrder {
    /// Nothing.
    None,
    /// The core stands still for so many cycles.
    Stall(u64),
    /// A reset; into the boot loader, or into the program.
    Reset {
        /// Into the boot loader.
        into_loader: bool,
    },
    /// The program is wrong.
    Misuse(Misuse),
}

/// Data flash with its registers.
#[derive(Clone, Debug)]
pub(super) struct Flash {
    bytes: Vec<u8>,
    data: u8,
    address: [u8; 2],
    command: u8,
    control: u8,
    is_armed: bool,
}

impl Flash {
    /// Erased.
    pub(super) fn new() -> Self {
        Self::with(vec![0xFF; DATA_BYTES])
    }

    /// The registers forget, the flash does not.
    pub(super) fn reset(&mut self) {
        *self = Self::with(std::mem::take(&mut self.bytes));
    }

    fn with(bytes: Vec<u8>) -> Self {
        Self {
            bytes,
            data: 0xFF,
            address: [0; 2],
            command: 0,
            control: 0,
            is_armed: false,
        }
    }

    pub(super) fn read(&self, register: u8) -> u8 {
        match register {
            ISP_DATA => self.data,
            ISP_ADDRH => self.address[0],
            ISP_ADDRL => self.address[1],
            ISP_CMD => self.command,
            ISP_CONTR => self.control,
            _ => 0,
        }
    }

    pub(super) fn write(&mut self, register: u8, value: u8) -> FlashOrder {
        let was_armed = std::mem::take(&mut self.is_armed);
        match register {
            ISP_DATA => self.data = value,
            ISP_ADDRH => self.address[0] = value,
            ISP_ADDRL => self.address[1] = value,
            ISP_CMD => self.command = value & 0x07,
            ISP_TRIG if was_armed && value == TRIGGER[1] => return self.begin(),
            ISP_TRIG => self.is_armed = value == TRIGGER[0],
            ISP_CONTR => {
                self.control = value & (ENABLE | LOADER | WAIT);
                if value & RESET != 0 {
                    let into_loader = value & LOADER != 0;
                    return FlashOrder::Reset { into_loader };
                }
            }
            _ => {}
        }
        FlashOrder::None
    }

    fn begin(&mut self) -> FlashOrder {
        if self.control & ENABLE == 0 {
            return FlashOrder::Misuse(Misuse::FlashNotEnabled);
        }
        let address = u16::from_be_bytes(self.address);
        let place = usize::from(address.wrapping_sub(DATA_START));
        if address < DATA_START || place >= DATA_BYTES {
            return FlashOrder::Misuse(Misuse::FlashAddress(address));
        }
        let Some(cycles) = CYCLES.get(usize::from(self.control & WAIT)) else {
            return FlashOrder::Misuse(Misuse::FlashWait(self.control & WAIT));
        };
        match self.command {
            0 => FlashOrder::None,
            1 => {
                self.data = self.bytes[place];
                FlashOrder::Stall(cycles[0])
            }
            2 => {
                // Writing can clear bits only.
                self.bytes[place] &= self.data;
                FlashOrder::Stall(cycles[1])
            }
            3 => {
                let start = place / SECTOR_BYTES * SECTOR_BYTES;
                self.bytes[start..start + SECTOR_BYTES].fill(0xFF);
                FlashOrder::Stall(cycles[2])
            }
            command => FlashOrder::Misuse(Misuse::FlashCommand(command)),
        }
    }

    /// All bytes.
    pub(super) fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}
