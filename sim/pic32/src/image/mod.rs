//! The content to program into the chip, read from an ELF or an Intel HEX file.

mod elf;
mod error;
mod hex;
mod symbols;

pub use error::{ElfPart, HexFault, ImageError};
pub use symbols::{Symbol, SymbolKind};

use crate::memory::{BOOT_BYTES, BOOT_START, FLASH_BYTES, FLASH_START};

/// The part that is emulated; an ELF may name the one that it was made for in a section `.librervac.part`.
pub const PART: &str = "PIC32MX360F256L";

/// Contents of both flashes; erased bytes are 0xFF. From an ELF it also has the names of functions and variables.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    flash: Vec<u8>,
    boot: Vec<u8>,
    symbols: Vec<Symbol>,
}

impl Image {
    /// Two erased flashes.
    pub fn erased() -> Self {
        Self {
            flash: vec![0xFF; FLASH_BYTES],
            boot: vec![0xFF; BOOT_BYTES],
            symbols: Vec::new(),
        }
    }

    /// Reads an ELF: 32 bit, little endian, MIPS32, linked for this part.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn from_elf(bytes: &[u8]) -> Result<Self, ImageError> {
        elf::read(bytes)
    }

    /// Reads Intel HEX with physical, KSEG0 or KSEG1 addresses.
    ///
    /// # Errors
    /// What is wrong with it, and in which line.
    pub fn from_hex(text: &str) -> Result<Self, ImageError> {
        hex::read(text)
    }

    /// Program flash, byte 0 at physical 0x1D00_0000.
    pub fn flash(&self) -> &[u8] {
        &self.flash
    }

    /// Boot flash, byte 0 at physical 0x1FC0_0000; its last 16 bytes are DEVCFG3..DEVCFG0.
    pub fn boot(&self) -> &[u8] {
        &self.boot
    }

    /// Functions and variables by address; empty when the file names none.
    pub fn symbols(&self) -> &[Symbol] {
        &self.symbols
    }

    /// The function or variable with this name, as the file spells it.
    pub fn symbol(&self, name: &str) -> Option<&Symbol> {
        self.symbols.iter().find(|symbol| symbol.name == name)
    }

    /// The function that an instruction belongs to, by its virtual address.
    pub fn function_at(&self, address: u32) -> Option<&Symbol> {
        let mut functions = self
            .symbols
            .iter()
            .filter(|symbol| symbol.kind == SymbolKind::Function);
        functions.rfind(|symbol| address.wrapping_sub(symbol.address) < symbol.size.max(1))
    }

    /// Replaces bytes at a physical address, or at its KSEG0 or KSEG1 alias.
    ///
    /// # Errors
    /// [`ImageError::OutsideFlash`] when a byte is in no flash; nothing is written then.
    pub fn write(&mut self, address: u32, bytes: &[u8]) -> Result<(), ImageError> {
        let length = bytes.len();
        let outside = || ImageError::OutsideFlash { address, length };
        let physical = physical(address).ok_or_else(outside)?;
        let (memory, start) = match physical {
            BOOT_START.. => (&mut self.boot, BOOT_START),
            FLASH_START.. => (&mut self.flash, FLASH_START),
            _ => return Err(outside()),
        };
        let start = (physical - start) as usize;
        let place = memory.get_mut(start..start + length).ok_or_else(outside)?;
        place.copy_from_slice(bytes);
        Ok(())
    }
}

/// The physical address of a physical, KSEG0 or KSEG1 address.
fn physical(address: u32) -> Option<u32> {
    match address >> 29 {
        0 | 4 | 5 => Some(address & 0x1FFF_FFFF),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{Image, ImageError};

    #[test]
    fn bytes_are_written_through_every_segment() {
        let mut image = Image::erased();
        for (index, address) in [0x1D00_0004, 0x9D00_0005, 0xBD00_0006, 0xBFC0_2FFF]
            .into_iter()
            .enumerate()
        {
            assert_eq!(image.write(address, &[index as u8]), Ok(()), "{address:#x}");
        }
        assert_eq!(image.flash()[3..8], [0xFF, 0, 1, 2, 0xFF]);
        assert_eq!(image.boot()[0x2FFE..], [0xFF, 3]);
    }

    #[test]
    fn nothing_is_written_outside_of_flash() {
        let mut image = Image::erased();
        for address in [
            0x1CFF_FFFF,
            0x1D03_FFFF,
            0x9D03_FFFF,
            0x1D04_0000,
            0x1FC0_2FFF,
            0x8000_0000,
            0x5D00_0000,
            u32::MAX,
        ] {
            let refused = ImageError::OutsideFlash { address, length: 2 };
            assert_eq!(image.write(address, &[0, 0]), Err(refused), "{address:#x}");
        }
        assert_eq!(image, Image::erased());
    }
}
