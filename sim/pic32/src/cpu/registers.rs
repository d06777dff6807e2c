//! The general registers of one set, addressed by the bytes of a decoded instruction.

use std::fmt;

/// A register that an instruction reads, 0..=31.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Source(u8);

/// A register that an instruction writes. Register 0 cannot be written: writes to it go to place 32, which is never
/// read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WriteTarget(u8);

impl Source {
    /// The register with a number, of which five bits count.
    pub(crate) const fn new(number: u32) -> Self {
        Self(number as u8 & 31)
    }

    /// Its number, 0..=31.
    pub(crate) const fn number(self) -> u8 {
        self.0
    }
}

impl WriteTarget {
    /// The register with a number, of which five bits count.
    pub(crate) const fn new(number: u32) -> Self {
        match number as u8 & 31 {
            0 => Self(32),
            number => Self(number),
        }
    }

    /// Whether the source names the register that is written here.
    pub(crate) const fn is_read_by(self, source: Source) -> bool {
        self.0 == source.0
    }
}

/// The registers. There is a place for each value of a byte, so that no access needs a check of its bounds.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct Registers([u32; 256]);

impl Registers {
    /// All zero; the chip comes up with anything in them.
    pub(crate) const fn new() -> Self {
        Self([0; 256])
    }

    /// What a register holds.
    #[inline(always)]
    pub(crate) fn get(&self, register: Source) -> u32 {
        self.0[usize::from(register.0)]
    }

    /// What a register holds, as a signed number.
    #[inline(always)]
    pub(crate) fn signed(&self, register: Source) -> i32 {
        self.get(register).cast_signed()
    }

    /// What a register holds plus a number: how addresses are made.
    #[inline(always)]
    pub(crate) fn sum(&self, register: Source, offset: u32) -> u32 {
        self.get(register).wrapping_add(offset)
    }

    /// What a register holds that is about to be written.
    #[inline(always)]
    pub(crate) fn before(&self, register: WriteTarget) -> u32 {
        self.0[usize::from(register.0)]
    }

    /// Puts a value into a register.
    #[inline(always)]
    pub(crate) fn set(&mut self, register: WriteTarget, value: u32) {
        self.0[usize::from(register.0)] = value;
    }
}

impl fmt::Debug for Registers {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_list().entries(&self.0[..32]).finish()
    }
}
