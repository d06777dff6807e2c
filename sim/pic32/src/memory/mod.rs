//! RAM, program flash and boot flash, exactly as big as those of the part.
//!
//! Flash is kept twice, as bytes and as decoded instructions, and shared between clones until one of them writes to it.

mod flash;
mod timing;

pub use timing::{FlashTiming, Prefetch};

use crate::cpu::operation::{Operation, Uncommon};
use crate::image::Image;
use flash::Flash;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

/// Bytes of RAM, at physical 0x0000_0000.
pub const RAM_BYTES: usize = 0x8000;
/// Bytes of program flash.
pub const FLASH_BYTES: usize = 0x4_0000;
/// Bytes of boot flash, the configuration words included.
pub const BOOT_BYTES: usize = 0x3000;
/// Physical address of program flash.
pub const FLASH_START: u32 = 0x1D00_0000;
/// Physical address of boot flash.
pub const BOOT_START: u32 = 0x1FC0_0000;

/// The memories of the chip.
#[derive(Clone, Debug)]
pub struct Memory {
    ram: Box<[u8; RAM_BYTES]>,
    program: Arc<Flash>,
    boot: Arc<Flash>,
    timing: FlashTiming,
    ram_wait_states: u8,
    ram_code: Range<u32>,
    ram_breakpoints: BTreeSet<u32>,
}

/// An address that no memory of the part has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{length} bytes at physical address {address:#010x} are in no memory of the PIC32MX360F256L")]
pub struct OutsideMemory {
    /// Physical address of the first byte.
    pub address: u32,
    /// How many bytes were meant.
    pub length: usize,
}

/// Where instructions come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Code {
    /// Program flash.
    Program,
    /// Boot flash.
    Boot,
    /// One instruction in RAM; it is decoded each time, because RAM changes.
    Ram(Operation),
}

/// What the inner loop needs of the memories, apart from the code that it runs.
#[derive(Debug)]
pub(crate) struct Open<'a> {
    pub(crate) ram: &'a mut [u8; RAM_BYTES],
    pub(crate) flash: &'a [u8],
    pub(crate) code: &'a [Operation],
}

impl Memory {
    /// Flash as in the image, RAM zero (on the chip it holds anything), registers as after a reset.
    pub fn new(image: &Image) -> Self {
        let mut memory = Self {
            ram: Box::new([0; RAM_BYTES]),
            program: Arc::new(Flash::new(image.flash())),
            boot: Arc::new(Flash::new(image.boot())),
            timing: FlashTiming::AFTER_RESET,
            ram_wait_states: 0,
            ram_code: 0..0,
            ram_breakpoints: BTreeSet::new(),
        };
        memory.reset();
        memory
    }

    /// What a reset does to the settings of flash and RAM; contents and breakpoints stay.
    pub fn reset(&mut self) {
        self.timing = FlashTiming::AFTER_RESET;
        self.ram_wait_states = 1;
        self.ram_code = 0..0;
    }

    /// RAM, byte 0 at physical address 0.
    pub fn ram(&self) -> &[u8; RAM_BYTES] {
        &self.ram
    }

    /// RAM, byte 0 at physical address 0.
    pub fn ram_mut(&mut self) -> &mut [u8; RAM_BYTES] {
        &mut self.ram
    }

    /// Reads bytes of RAM, program flash or boot flash at a physical address.
    ///
    /// # Errors
    /// When a byte lies outside; nothing is read then.
    pub fn read(&self, address: u32, bytes: &mut [u8]) -> Result<(), OutsideMemory> {
        let length = bytes.len();
        let outside = OutsideMemory { address, length };
        let memory = match address {
            ..FLASH_START => self.ram.as_slice(),
            FLASH_START..BOOT_START => self.program.bytes(),
            BOOT_START.. => self.boot.bytes(),
        };
        let start = offset(address);
        let found = memory.get(start..start + length).ok_or(outside)?;
        bytes.copy_from_slice(found);
        Ok(())
    }

    /// Writes bytes to RAM, program flash or boot flash as a programmer or the flash controller does.
    ///
    /// # Errors
    /// When a byte lies outside; nothing is written then.
    pub fn write(&mut self, address: u32, bytes: &[u8]) -> Result<(), OutsideMemory> {
        let length = bytes.len();
        let outside = OutsideMemory { address, length };
        let start = offset(address);
        let flash = match address {
            ..FLASH_START => {
                let place = self.ram.get_mut(start..start + length).ok_or(outside)?;
                place.copy_from_slice(bytes);
                return Ok(());
            }
            FLASH_START..BOOT_START => &mut self.program,
            BOOT_START.. => &mut self.boot,
        };
        if start + length > flash.bytes().len() {
            return Err(outside);
        }
        Arc::make_mut(flash).write(start, bytes);
        Ok(())
    }

    /// Takes over what CHECON says.
    pub fn set_flash_timing(&mut self, timing: FlashTiming) {
        self.timing = timing;
    }

    /// What CHECON said last.
    pub fn flash_timing(&self) -> FlashTiming {
        self.timing
    }

    /// Takes over BMXCON.BMXWSDRM: 0 or 1 cycle more for each load from RAM.
    pub fn set_ram_wait_states(&mut self, wait_states: u8) {
        self.ram_wait_states = wait_states;
    }

    pub(crate) fn ram_wait_states(&self) -> u8 {
        self.ram_wait_states
    }

    /// Takes over what the bus matrix says: the offsets in RAM that may be executed in kernel mode, which are
    /// BMXDKPBA..BMXDUDBA, and nothing while BMXDKPBA is 0. Fetches elsewhere in RAM are bus errors.
    pub fn set_ram_code(&mut self, offsets: Range<u32>) {
        self.ram_code = offsets;
    }

    /// Stops [`Cpu::run`](crate::cpu::Cpu::run) before the instruction at a physical address.
    ///
    /// # Errors
    /// When no memory is there.
    pub fn set_breakpoint(&mut self, address: u32) -> Result<(), OutsideMemory> {
        self.mark_breakpoint(address, true)
    }

    /// Takes a breakpoint away; it need not be there.
    ///
    /// # Errors
    /// When no memory is there.
    pub fn clear_breakpoint(&mut self, address: u32) -> Result<(), OutsideMemory> {
        self.mark_breakpoint(address, false)
    }

    fn mark_breakpoint(&mut self, address: u32, wanted: bool) -> Result<(), OutsideMemory> {
        self.read(address, &mut [0; 4])?;
        match address {
            ..FLASH_START if wanted => _ = self.ram_breakpoints.insert(address),
            ..FLASH_START => _ = self.ram_breakpoints.remove(&address),
            FLASH_START..BOOT_START => Arc::make_mut(&mut self.program).mark(offset(address), wanted),
            BOOT_START.. => Arc::make_mut(&mut self.boot).mark(offset(address), wanted),
        }
        Ok(())
    }

    /// The code at a physical address, and the physical address at which that code begins; none when nothing can be
    /// executed there.
    pub(crate) fn code(&self, address: u32) -> Option<(Code, u32)> {
        match address {
            ..FLASH_START => Some((Code::Ram(self.ram_operation(address)?), address)),
            FLASH_START..BOOT_START if offset(address) < FLASH_BYTES => Some((Code::Program, FLASH_START)),
            BOOT_START.. if offset(address) < BOOT_BYTES => Some((Code::Boot, BOOT_START)),
            _ => None,
        }
    }

    fn ram_operation(&self, address: u32) -> Option<Operation> {
        if !self.ram_code.contains(&address) {
            return None;
        }
        if self.ram_breakpoints.contains(&address) {
            return Some(Operation::Uncommon(Uncommon::Breakpoint));
        }
        let word = |index: usize| {
            let bytes = self.ram.get(index * 4..index * 4 + 4)?;
            Some(u32::from_le_bytes(bytes.try_into().ok()?))
        };
        Some(crate::cpu::decode::decode_at(word, offset(address) / 4))
    }

    /// What the inner loop works on; `operation` is the room for an instruction in RAM.
    pub(crate) fn open<'a>(&'a mut self, code: Code, operation: &'a mut [Operation; 1]) -> Open<'a> {
        let code = match code {
            Code::Program => self.program.operations(),
            Code::Boot => self.boot.operations(),
            Code::Ram(found) => {
                *operation = [found];
                operation
            }
        };
        Open {
            ram: &mut self.ram,
            flash: self.program.bytes(),
            code,
        }
    }
}

/// Where in its memory an address is.
fn offset(address: u32) -> usize {
    let start = match address {
        ..FLASH_START => 0,
        FLASH_START..BOOT_START => FLASH_START,
        BOOT_START.. => BOOT_START,
    };
    (address - start) as usize
}
