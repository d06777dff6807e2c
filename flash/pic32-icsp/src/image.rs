//! What a chip holds: both flashes, the configuration words at the end of boot flash among them.

/// Physical address of program flash.
pub const PROGRAM_START: u32 = 0x1D00_0000;
/// Its size.
pub const PROGRAM_BYTES: usize = 0x4_0000;
/// Physical address of boot flash.
pub const BOOT_START: u32 = 0x1FC0_0000;
/// Its size, with DEVCFG3 to DEVCFG0 as the last 16 bytes.
pub const BOOT_BYTES: usize = 0x3000;
/// Bytes that are erased at once.
pub const PAGE_BYTES: usize = 0x1000;
/// Bytes that are programmed at once.
pub(crate) const ROW_BYTES: usize = 0x200;
/// The configuration words.
pub(crate) const CONFIGURATION_BYTES: usize = 16;

/// What configuration words could do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConfigurationRisk {
    /// CP is 0.
    CodeProtection,
    /// BWP is 0 or PWP not all ones.
    WriteProtection,
    /// Bit 31 of DEVCFG0 must be 0.
    SignBit,
}

impl std::fmt::Display for ConfigurationRisk {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(match self {
            Self::CodeProtection => "protect the chip against reading (CP)",
            Self::WriteProtection => "protect flash against writing (BWP, PWP)",
            Self::SignBit => "set bit 31 of DEVCFG0, which must be 0",
        })
    }
}

/// The whole content of a chip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FlashImage {
    program: Vec<u8>,
    boot: Vec<u8>,
}

impl FlashImage {
    /// An erased chip.
    pub fn erased() -> Self {
        Self {
            program: vec![0xFF; PROGRAM_BYTES],
            boot: vec![0xFF; BOOT_BYTES],
        }
    }

    /// From both flashes; none when a size is wrong.
    pub fn of(program: &[u8], boot: &[u8]) -> Option<Self> {
        (program.len() == PROGRAM_BYTES && boot.len() == BOOT_BYTES).then(|| Self {
            program: program.to_vec(),
            boot: boot.to_vec(),
        })
    }

    /// Program flash.
    pub fn program(&self) -> &[u8] {
        &self.program
    }

    /// Boot flash.
    pub fn boot(&self) -> &[u8] {
        &self.boot
    }

    /// Replaces bytes at a physical address, or its KSEG0 or KSEG1 alias. Says whether all of them fit; writes nothing otherwise.
    #[must_use]
    pub fn write(&mut self, address: u32, bytes: &[u8]) -> bool {
        let physical = address & 0x1FFF_FFFF;
        let (memory, start) = match physical {
            BOOT_START.. => (&mut self.boot, BOOT_START),
            PROGRAM_START.. => (&mut self.program, PROGRAM_START),
            _ => return false,
        };
        let start = (physical - start) as usize;
        match memory.get_mut(start..start.saturating_add(bytes.len())) {
            Some(place) => {
                place.copy_from_slice(bytes);
                true
            }
            None => false,
        }
    }

    /// Pages in the order in which they are written: boot flash after program flash, so that a chip whose writing was cut off does
    /// not start half a program; the page with the configuration words last.
    pub(crate) fn pages(&self) -> impl Iterator<Item = (u32, &[u8])> {
        let of = |start: u32, bytes| {
            let pages = <[u8]>::chunks(bytes, PAGE_BYTES).enumerate();
            pages.map(move |(index, page)| (start + (index * PAGE_BYTES) as u32, page))
        };
        of(PROGRAM_START, self.program.as_slice()).chain(of(BOOT_START, self.boot.as_slice()))
    }

    /// The bytes of a page to be filled.
    pub(crate) fn page_mut(&mut self, address: u32) -> Option<&mut [u8]> {
        let (memory, start) = match address {
            BOOT_START.. => (&mut self.boot, BOOT_START),
            _ => (&mut self.program, PROGRAM_START),
        };
        let start = address.checked_sub(start)? as usize;
        memory.get_mut(start..start + PAGE_BYTES)
    }

    /// DEVCFG3, DEVCFG2, DEVCFG1, DEVCFG0.
    pub fn configuration(&self) -> [u32; 4] {
        let mut words = [u32::MAX; 4];
        let start = BOOT_BYTES - CONFIGURATION_BYTES;
        for (word, bytes) in words.iter_mut().zip(self.boot[start..].chunks_exact(4)) {
            *word = word_of(bytes);
        }
        words
    }

    /// What the configuration words would do that makes the chip hard to reach.
    pub fn configuration_risk(&self) -> Option<ConfigurationRisk> {
        let [.., word] = self.configuration();
        let is_erased = word == u32::MAX;
        match word {
            _ if word & 1 << 28 == 0 => Some(ConfigurationRisk::CodeProtection),
            _ if word & 1 << 24 == 0 || word >> 12 & 0xFF != 0xFF => Some(ConfigurationRisk::WriteProtection),
            _ if word >> 31 != 0 && !is_erased => Some(ConfigurationRisk::SignBit),
            _ => None,
        }
    }
}

/// A word of four bytes; missing ones count as erased.
pub(crate) fn word_of(bytes: &[u8]) -> u32 {
    let mut word = [0xFF; 4];
    for (place, byte) in word.iter_mut().zip(bytes) {
        *place = *byte;
    }
    u32::from_le_bytes(word)
}

#[cfg(test)]
mod tests {
    use super::{ConfigurationRisk, FlashImage};

    fn with_devcfg0(word: u32) -> FlashImage {
        let mut image = FlashImage::erased();
        assert!(image.write(0xBFC0_2FFC, &word.to_le_bytes()));
        image
    }

    #[test]
    fn each_risk_of_the_configuration_is_named() {
        let cases = [
            (0x7FFF_FFFF, None),
            (0xFFFF_FFFF, None),
            (0x6FFF_FFFF, Some(ConfigurationRisk::CodeProtection)),
            (0x7EFF_FFFF, Some(ConfigurationRisk::WriteProtection)),
            (0x7FF7_FFFF, Some(ConfigurationRisk::WriteProtection)),
            (0xFFFF_FFFE, Some(ConfigurationRisk::SignBit)),
        ];
        for (word, expected) in cases {
            assert_eq!(with_devcfg0(word).configuration_risk(), expected, "{word:#x}");
        }
    }

    #[test]
    fn nothing_is_written_outside_of_flash() {
        let mut image = FlashImage::erased();
        for address in [0x1CFF_FFFF, 0x1D03_FFFF, 0x1FC0_2FFF, 0x8000_0000, u32::MAX] {
            assert!(!image.write(address, &[0, 0]), "{address:#x}");
        }
        assert_eq!(image, FlashImage::erased());
        assert_eq!(image.pages().count(), 67);
    }
}
