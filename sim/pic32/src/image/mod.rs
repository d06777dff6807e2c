//! What is programmed into the chip, read from an ELF or an Intel HEX file.

use crate::memory::{BOOT_BYTES, BOOT_START, FLASH_BYTES, FLASH_START};

/// Contents of both flashes; erased bytes are 0xFF.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    flash: Vec<u8>,
    boot: Vec<u8>,
}

/// Why bytes are no image for this part.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// Bytes that this part has no flash for.
    #[error(
        "{length} bytes at physical address {address:#010x} are outside of the flash of the PIC32MX360F256L \
         (program flash 0x1d000000..0x1d040000, boot flash 0x1fc00000..0x1fc03000): link for this part"
    )]
    OutsideFlash {
        /// Physical address of the first byte.
        address: u32,
        /// How many bytes.
        length: usize,
    },
}

impl Image {
    /// Two erased flashes.
    pub fn erased() -> Self {
        Self {
            flash: vec![0xFF; FLASH_BYTES],
            boot: vec![0xFF; BOOT_BYTES],
        }
    }

    /// Program flash, byte 0 at physical 0x1D00_0000.
    pub fn flash(&self) -> &[u8] {
        &self.flash
    }

    /// Boot flash, byte 0 at physical 0x1FC0_0000; its last 16 bytes are DEVCFG3..DEVCFG0.
    pub fn boot(&self) -> &[u8] {
        &self.boot
    }

    /// Replaces bytes at a physical address, or at its KSEG0 or KSEG1 alias.
    ///
    /// # Errors
    /// [`ImageError::OutsideFlash`] when a byte is in no flash; nothing is written then.
    pub fn write(&mut self, address: u32, bytes: &[u8]) -> Result<(), ImageError> {
        let physical = address & 0x1FFF_FFFF;
        let outside = || ImageError::OutsideFlash {
            address: physical,
            length: bytes.len(),
        };
        let (memory, start) = match physical {
            BOOT_START.. => (&mut self.boot, BOOT_START),
            FLASH_START.. => (&mut self.flash, FLASH_START),
            _ => return Err(outside()),
        };
        let start = (physical - start) as usize;
        let place = memory.get_mut(start..start + bytes.len()).ok_or_else(outside)?;
        place.copy_from_slice(bytes);
        Ok(())
    }
}
