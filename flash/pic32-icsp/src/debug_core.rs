//! The core executes instructions that come over the wires, one after the other.

use crate::error::IcspError;
use crate::pins::IcspPins;
use crate::test_port::TestPort;

const SWITCH_TO_PROBE: u8 = 0x05;
const DATA: u8 = 0x09;
const CONTROL: u8 = 0x0A;
const PROBE_BOOT: u8 = 0x0C;
const FAST_DATA: u8 = 0x0E;

const ASSERT_RESET: u8 = 0xD1;
const RELEASE_RESET: u8 = 0xD0;
const ENABLE_FLASH: u8 = 0xFE;

/// CONTROL: probe enabled, its vector used, and with the access pending left as it is.
const LOOK: u32 = 0x0004_C000;
/// The same, and the pending access is done.
const COMPLETE: u32 = 0x0000_C000;
const PENDING: u32 = 1 << 18;
/// How often CONTROL is looked at for a pending access.
const POLLS: u32 = 200;
/// How often the core is started.
const STARTS: u32 = 20;

/// A register of the core, as instructions number it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CoreRegister(u32);

pub(crate) const A0: CoreRegister = CoreRegister(4);
pub(crate) const A1: CoreRegister = CoreRegister(5);
const T9: CoreRegister = CoreRegister(25);

const fn lui(to: CoreRegister, value: u32) -> u32 {
    0x3C00_0000 | to.0 << 16 | value >> 16
}

const fn ori(to: CoreRegister, value: u32) -> u32 {
    0x3400_0000 | to.0 << 21 | to.0 << 16 | value & 0xFFFF
}

/// Store `from` at the address that is in `base`.
const fn sw(from: CoreRegister, base: CoreRegister) -> u32 {
    0xAC00_0000 | base.0 << 21 | from.0 << 16
}

impl<P: IcspPins> TestPort<'_, P> {
    /// Starts the core in debug mode: it waits for its first instruction.
    pub(crate) fn start_core(&mut self) -> Result<(), IcspError<P::Error>> {
        for _ in 0..STARTS {
            self.select_commands()?;
            self.byte(ASSERT_RESET)?;
            self.instruction(SWITCH_TO_PROBE)?;
            self.reset()?;
            self.instruction(PROBE_BOOT)?;
            self.select_commands()?;
            self.byte(RELEASE_RESET)?;
            self.byte(ENABLE_FLASH)?;
            self.instruction(SWITCH_TO_PROBE)?;
            self.reset()?;
            self.instruction(CONTROL)?;
            // The first look enables the probe, the second sees what it led to.
            self.word(LOOK)?;
            if self.word(LOOK)? & PENDING != 0 {
                return Ok(());
            }
        }
        Err(IcspError::CoreSilent)
    }

    /// The core executes this instruction.
    pub(crate) fn execute(&mut self, instruction: u32) -> Result<(), IcspError<P::Error>> {
        self.instruction(CONTROL)?;
        let mut polls = 0;
        while self.word(LOOK)? & PENDING == 0 {
            polls += 1;
            if polls > POLLS {
                return Err(IcspError::CoreSilent);
            }
        }
        self.instruction(DATA)?;
        self.word(instruction)?;
        self.instruction(CONTROL)?;
        self.word(COMPLETE).map(|_| ())
    }

    fn load(&mut self, to: CoreRegister, value: u32) -> Result<(), IcspError<P::Error>> {
        self.execute(lui(to, value))?;
        self.execute(ori(to, value))
    }

    /// Stores a word at a virtual address.
    pub(crate) fn store(&mut self, address: u32, value: u32) -> Result<(), IcspError<P::Error>> {
        self.load(A0, address)?;
        self.load(A1, value)?;
        self.execute(sw(A1, A0))
    }

    /// Goes on at a virtual address; from then on the core and the probe exchange words.
    pub(crate) fn jump(&mut self, address: u32) -> Result<(), IcspError<P::Error>> {
        self.load(T9, address)?;
        self.execute(T9.0 << 21 | 0x08)?;
        self.execute(0)?;
        self.instruction(FAST_DATA)
    }
}

#[cfg(test)]
mod tests {
    use super::{A0, A1, CoreRegister, T9, lui, ori, sw};

    /// Words that stand in the reference, which assembled them with binutils.
    #[test]
    fn instructions_are_those_of_the_reference() {
        assert_eq!(lui(A0, 0xBF88_2000), 0x3C04_BF88);
        assert_eq!(ori(A0, 0xBF88_2000), 0x3484_2000);
        assert_eq!(lui(A1, 0x001F_0040), 0x3C05_001F);
        assert_eq!(sw(A1, A0), 0xAC85_0000);
        assert_eq!(lui(T9, 0xA000_0800), 0x3C19_A000);
        assert_eq!(T9.0 << 21 | 8, 0x0320_0008);
        assert_eq!(lui(CoreRegister(19), 0xFF20_0000), 0x3C13_FF20);
    }
}
