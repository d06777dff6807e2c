//! The program to write into the chip, read from an Intel HEX file.

mod error;
mod hex;

pub use error::{HexFault, ImageError};

use crate::cpu::{CODE_BYTES, Code};

/// Contents of the program flash; erased bytes are 0xFF.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    flash: Vec<u8>,
    /// One behind the highest byte that the file names.
    end: usize,
}

impl Image {
    /// An erased flash.
    #[must_use]
    pub fn erased() -> Self {
        Self {
            flash: vec![0xFF; CODE_BYTES],
            end: 0,
        }
    }

    /// Reads Intel HEX.
    ///
    /// # Errors
    /// What is wrong with it, and in which line.
    pub fn from_hex(text: &str) -> Result<Self, ImageError> {
        hex::read(text)
    }

    /// All bytes, from address 0 on.
    #[must_use]
    pub fn flash(&self) -> &[u8] {
        &self.flash
    }

    /// The address behind the last byte of the program.
    #[must_use]
    pub fn end(&self) -> usize {
        self.end
    }

    /// The program as the core fetches it.
    #[must_use]
    pub fn code(&self) -> Code {
        Code::new(&self.flash)
    }

    /// Puts bytes at an address; says whether all of them fit, and writes nothing otherwise.
    #[must_use]
    pub fn write(&mut self, address: u32, bytes: &[u8]) -> bool {
        let start = address as usize;
        let end = start.saturating_add(bytes.len());
        let Some(place) = self.flash.get_mut(start..end) else {
            return false;
        };
        place.copy_from_slice(bytes);
        if !bytes.is_empty() {
            self.end = self.end.max(end);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::Image;

    #[test]
    fn bytes_are_written_into_the_flash_only() {
        let mut image = Image::erased();
        assert!(image.write(0x7FFE, &[1, 2]));
        assert_eq!(image.flash()[0x7FFD..], [0xFF, 1, 2]);
        assert_eq!(image.end(), 0x8000);
        let before = image.clone();
        for address in [0x7FFF, 0x8000, u32::MAX] {
            assert!(!image.write(address, &[3, 4]), "{address:#x}");
        }
        assert_eq!(image, before);
    }
}
