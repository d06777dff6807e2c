//! The option byte of the chip.

/// XRAM is on.
const XRAM: u8 = 1 << 6;
/// 1 keeps data flash when the program is written.
const KEEP_DATA: u8 = 1 << 3;
/// 1 lets the loader start without looking at P1.0 and P1.1.
const LOADER_OPEN: u8 = 1 << 2;
/// 0 is six clocks a cycle.
const TWELVE_CLOCKS: u8 = 1 << 0;

/// An option byte that may be written: XRAM on, data flash kept, and the loader open. There is no way to make another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OptionByte(u8);

impl OptionByte {
    /// What the chip has now, with what must be set.
    pub const fn from_chip(found: u8) -> Self {
        Self(found | XRAM | KEEP_DATA | LOADER_OPEN)
    }

    /// The byte as it goes over the line.
    pub const fn byte(self) -> u8 {
        self.0
    }
}

/// Clocks of a machine cycle, by an option byte of a chip.
pub(crate) const fn clocks_per_cycle(found: u8) -> u32 {
    if found & TWELVE_CLOCKS == 0 { 6 } else { 12 }
}

#[cfg(test)]
mod tests {
    use super::{OptionByte, clocks_per_cycle};

    #[test]
    fn no_option_byte_closes_the_loader() {
        for found in 0..=u8::MAX {
            let written = OptionByte::from_chip(found).byte();
            assert_eq!(written & 0x4C, 0x4C, "{found:#x}");
            assert_eq!(
                written & !0x4C,
                found & !0x4C,
                "{found:#x}: everything else stays"
            );
            assert_eq!(clocks_per_cycle(written), clocks_per_cycle(found));
        }
    }
}
