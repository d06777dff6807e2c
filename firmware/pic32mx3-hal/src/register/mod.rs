//! Access to special function registers.
//!
//! A [`Register`] can only be made here and in [`map`], from the addresses of the chip's tables, so reading and writing one
//! is safe for memory with any value. On a machine that is no MIPS the registers are plain memory (`host`): programs for
//! the chip can be compiled and checked there, and tests see what was written.

pub(crate) mod map;

#[cfg(not(target_arch = "mips"))]
mod host;

/// Distances to the registers that clear, set and invert the bits written as ones (section 5 and 8).
const CLEAR: u32 = 4;
const SET: u32 = 8;
const INVERT: u32 = 12;

/// The address of a 32-bit special function register in KSEG1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Register(u32);

impl Register {
    const fn at(address: u32) -> Self {
        Self(address)
    }

    /// A register some bytes behind this one, in the same block.
    const fn plus(self, bytes: u32) -> Self {
        Self(self.0 + bytes)
    }

    /// Where the DMA controller finds it.
    pub(crate) const fn physical_address(self) -> u32 {
        self.0 & 0x1FFF_FFFF
    }

    #[inline(always)]
    pub(crate) fn read(self) -> u32 {
        load(self.0)
    }

    #[inline(always)]
    pub(crate) fn write(self, value: u32) {
        store(self.0, value);
    }

    /// Clears the bits that are ones in `bits`, in one access that no interrupt can divide.
    #[inline(always)]
    pub(crate) fn clear(self, bits: u32) {
        store(self.0 + CLEAR, bits);
    }

    /// Sets the bits that are ones in `bits`, in one access.
    #[inline(always)]
    pub(crate) fn set(self, bits: u32) {
        store(self.0 + SET, bits);
    }

    /// Inverts the bits that are ones in `bits`, in one access.
    #[inline(always)]
    pub(crate) fn invert(self, bits: u32) {
        store(self.0 + INVERT, bits);
    }

    #[inline(always)]
    pub(crate) fn has(self, bits: u32) -> bool {
        self.read() & bits == bits
    }
}

#[cfg(target_arch = "mips")]
#[inline(always)]
fn load(address: u32) -> u32 {
    // SAFETY: the address is one of the register map, aligned, always mapped, and no memory of Rust objects.
    unsafe { core::ptr::with_exposed_provenance::<u32>(address as usize).read_volatile() }
}

#[cfg(target_arch = "mips")]
#[inline(always)]
fn store(address: u32, value: u32) {
    // SAFETY: as for `load`; no register that is written here moves memory by itself (the flash controller only
    // through the crate's module `flash`, which checks the address).
    unsafe { core::ptr::with_exposed_provenance_mut::<u32>(address as usize).write_volatile(value) }
}

#[cfg(not(target_arch = "mips"))]
use host::{load, store};
