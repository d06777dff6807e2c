//! RAM, program flash and boot flash, exactly as big as those of the part, with every flash word decoded.

use crate::image::Image;
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

/// When the prefetch unit helps instruction fetches (CHECON.PREFEN).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prefetch {
    /// Never.
    Off,
    /// Through KSEG0.
    Cached,
    /// Through KSEG1.
    Uncached,
    /// Through both.
    Both,
}

/// What CHECON says about flash accesses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlashTiming {
    /// Cycles that a flash access takes beyond one, 0..=7.
    pub wait_states: u8,
    /// When they are hidden.
    pub prefetch: Prefetch,
}

/// The memories of the chip. Cloning shares flash until one of the clones writes to it.
#[derive(Clone, Debug)]
pub struct Memory {
    ram: Box<[u8; RAM_BYTES]>,
    flash: Arc<Vec<u8>>,
    boot: Arc<Vec<u8>>,
    timing: FlashTiming,
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

impl Memory {
    /// Flash as in the image, RAM zero (on the chip it holds anything).
    pub fn new(image: &Image) -> Self {
        Self {
            ram: Box::new([0; RAM_BYTES]),
            flash: Arc::new(image.flash().to_vec()),
            boot: Arc::new(image.boot().to_vec()),
            timing: FlashTiming {
                wait_states: 7,
                prefetch: Prefetch::Off,
            },
        }
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
        let outside = OutsideMemory {
            address,
            length: bytes.len(),
        };
        let (memory, start): (&[u8], u32) = match address {
            ..FLASH_START => (self.ram.as_slice(), 0),
            FLASH_START..BOOT_START => (&self.flash, FLASH_START),
            _ => (&self.boot, BOOT_START),
        };
        let start = usize::try_from(address - start).map_err(|_| outside)?;
        let found = memory.get(start..start + bytes.len()).ok_or(outside)?;
        bytes.copy_from_slice(found);
        Ok(())
    }

    /// Writes bytes to RAM, program flash or boot flash as a programmer or the flash controller does.
    ///
    /// # Errors
    /// When a byte lies outside; nothing is written then.
    pub fn write(&mut self, address: u32, bytes: &[u8]) -> Result<(), OutsideMemory> {
        let outside = OutsideMemory {
            address,
            length: bytes.len(),
        };
        let (memory, start): (&mut [u8], u32) = match address {
            ..FLASH_START => (self.ram.as_mut_slice(), 0),
            FLASH_START..BOOT_START => (Arc::make_mut(&mut self.flash).as_mut_slice(), FLASH_START),
            _ => (Arc::make_mut(&mut self.boot).as_mut_slice(), BOOT_START),
        };
        let start = usize::try_from(address - start).map_err(|_| outside)?;
        let place = memory.get_mut(start..start + bytes.len()).ok_or(outside)?;
        place.copy_from_slice(bytes);
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
}
