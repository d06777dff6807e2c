//! Loads and stores that need nothing but memory: RAM through KSEG0 and KSEG1, and loads from program flash.
//!
//! Everything else (registers of the chip, boot flash, misaligned addresses, what is nowhere) is answered with nothing here
//! and done in `data.rs`.

use crate::memory::{FLASH_START, Open, RAM_BYTES};

/// The bit by which KSEG0 and KSEG1 differ.
const UNCACHED: u32 = 0x2000_0000;
/// KSEG0 begins here.
const KSEG0: u32 = 0x8000_0000;
/// The bits of an address in RAM that its size leaves free.
const RAM_MASK: u32 = RAM_BYTES as u32 - 1;

/// Where in RAM an access with this alignment (0, 1 or 3) goes, if it goes there.
#[inline(always)]
fn in_ram(address: u32, alignment: u32) -> Option<usize> {
    let inside = RAM_MASK & !alignment;
    (address & !(UNCACHED | inside) == KSEG0).then_some((address & inside) as usize)
}

impl Open<'_> {
    /// Bytes at an aligned address and whether they came from flash.
    #[inline(always)]
    fn load<const N: usize>(&self, address: u32) -> Option<([u8; N], bool)> {
        let alignment = N as u32 - 1;
        if let Some(start) = in_ram(address, alignment) {
            let bytes = self.ram.get(start..)?.first_chunk()?;
            return Some((*bytes, false));
        }
        let start = (address & !(UNCACHED | alignment)).wrapping_sub(KSEG0 | FLASH_START);
        let bytes = self.flash.get(start as usize..)?.first_chunk()?;
        (address & alignment == 0).then_some((*bytes, true))
    }

    #[inline(always)]
    pub(crate) fn load_u8(&self, address: u32) -> Option<(u32, bool)> {
        let ([byte], is_flash) = self.load(address)?;
        Some((u32::from(byte), is_flash))
    }

    #[inline(always)]
    pub(crate) fn load_i8(&self, address: u32) -> Option<(u32, bool)> {
        let ([byte], is_flash) = self.load(address)?;
        Some((i32::from(byte.cast_signed()).cast_unsigned(), is_flash))
    }

    #[inline(always)]
    pub(crate) fn load_u16(&self, address: u32) -> Option<(u32, bool)> {
        let (bytes, is_flash) = self.load(address)?;
        Some((u32::from(u16::from_le_bytes(bytes)), is_flash))
    }

    #[inline(always)]
    pub(crate) fn load_i16(&self, address: u32) -> Option<(u32, bool)> {
        let (bytes, is_flash) = self.load(address)?;
        Some((i32::from(i16::from_le_bytes(bytes)).cast_unsigned(), is_flash))
    }

    #[inline(always)]
    pub(crate) fn load_u32(&self, address: u32) -> Option<(u32, bool)> {
        let (bytes, is_flash) = self.load(address)?;
        Some((u32::from_le_bytes(bytes), is_flash))
    }

    /// What `lwl` makes of a register and the word around an address.
    #[inline(always)]
    pub(crate) fn load_left(&self, address: u32, before: u32) -> Option<(u32, bool)> {
        let (word, is_flash) = self.load_u32(address & !3)?;
        Some((merge_left(address, word, before), is_flash))
    }

    /// What `lwr` makes of them.
    #[inline(always)]
    pub(crate) fn load_right(&self, address: u32, before: u32) -> Option<(u32, bool)> {
        let (word, is_flash) = self.load_u32(address & !3)?;
        Some((merge_right(address, word, before), is_flash))
    }

    /// Puts bytes at an aligned address in RAM.
    #[inline(always)]
    pub(crate) fn store<const N: usize>(&mut self, address: u32, bytes: [u8; N]) -> Option<()> {
        let start = in_ram(address, N as u32 - 1)?;
        *self.ram.get_mut(start..)?.first_chunk_mut()? = bytes;
        Some(())
    }

    /// What `swl` does to the word around an address.
    #[inline(always)]
    pub(crate) fn store_left(&mut self, address: u32, value: u32) -> Option<()> {
        let place = self.word(address)?;
        *place = split_left(address, u32::from_le_bytes(*place), value).to_le_bytes();
        Some(())
    }

    /// What `swr` does to it.
    #[inline(always)]
    pub(crate) fn store_right(&mut self, address: u32, value: u32) -> Option<()> {
        let place = self.word(address)?;
        *place = split_right(address, u32::from_le_bytes(*place), value).to_le_bytes();
        Some(())
    }

    /// The word of RAM around an address.
    #[inline(always)]
    fn word(&mut self, address: u32) -> Option<&mut [u8; 4]> {
        let start = in_ram(address & !3, 3)?;
        self.ram.get_mut(start..)?.first_chunk_mut()
    }
}

/// What `lwl` makes of a register and the word around an address (little endian).
#[inline(always)]
pub(crate) fn merge_left(address: u32, word: u32, before: u32) -> u32 {
    let shift = 24 - 8 * (address & 3);
    word << shift | before & !(u32::MAX << shift)
}

/// What `lwr` makes of them.
#[inline(always)]
pub(crate) fn merge_right(address: u32, word: u32, before: u32) -> u32 {
    let shift = 8 * (address & 3);
    word >> shift | before & !(u32::MAX >> shift)
}

/// What `swl` makes of the word around an address.
#[inline(always)]
pub(crate) fn split_left(address: u32, word: u32, value: u32) -> u32 {
    let shift = 24 - 8 * (address & 3);
    value >> shift | word & !(u32::MAX >> shift)
}

/// What `swr` makes of it.
#[inline(always)]
pub(crate) fn split_right(address: u32, word: u32, value: u32) -> u32 {
    let shift = 8 * (address & 3);
    value << shift | word & !(u32::MAX << shift)
}
