//! Program memory as the core fetches from it.

use super::{Bus, CoreFault, Cpu};
use std::sync::Arc;

/// Program flash of the part.
pub const CODE_BYTES: usize = 0x8000;

/// What the core finds where there is no flash: the reserved instruction, which it reports. What the chip would fetch
/// there through its pins is not known.
const BEYOND: u8 = 0xA5;

/// Program memory; clones share it. A program cannot change it: the chip's own programming reaches data flash only.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Code(Arc<[u8; 0x1_0000]>);

impl Code {
    /// Code from address 0 on. The rest of the flash is erased, and what does not fit into it is left out.
    #[must_use]
    pub fn new(bytes: &[u8]) -> Self {
        let mut code = [BEYOND; 0x1_0000];
        code[..CODE_BYTES].fill(0xFF);
        for (place, byte) in code[..CODE_BYTES].iter_mut().zip(bytes) {
            *place = *byte;
        }
        Self(Arc::new(code))
    }

    /// The byte at an address.
    #[must_use]
    pub fn byte(&self, address: u16) -> u8 {
        self.0[usize::from(address)]
    }
}

impl Cpu {
    /// The next byte of the program.
    #[inline]
    pub(super) fn fetch(&mut self) -> u8 {
        let byte = self.code.byte(self.pc);
        self.pc = self.pc.wrapping_add(1);
        byte
    }

    /// The next two bytes, upper half first.
    #[inline]
    pub(super) fn fetch_word(&mut self) -> u16 {
        let high = self.fetch();
        u16::from_be_bytes([high, self.fetch()])
    }

    /// MOVC.
    pub(super) fn load_code<B: Bus>(&mut self, base: u16, bus: &mut B) {
        let address = base.wrapping_add(u16::from(self.a));
        self.a = self.code.byte(address);
        if usize::from(address) >= CODE_BYTES {
            self.a = 0xFF;
            bus.note(CoreFault::DataBeyondFlash, self.access_cycle());
        }
    }
}
