//! How much stack was ever used. The start-up code paints it.

#[cfg(target_arch = "mips")]
use core::ptr;

/// What unused stack holds; `start/reset.S` has the same.
#[cfg(target_arch = "mips")]
const PAINT: u32 = 0x5AC1_D0E5;

#[cfg(target_arch = "mips")]
unsafe extern "C" {
    static __stack_bottom: u32;
    static __stack_top: u32;
}

/// Bytes between the last variable and the end of memory.
#[cfg(target_arch = "mips")]
#[must_use]
pub fn size() -> usize {
    (&raw const __stack_top).addr() - (&raw const __stack_bottom).addr()
}

/// Whether the lowest word of the stack still has its paint: a canary. When it has not, variables may have been overwritten.
#[cfg(target_arch = "mips")]
#[must_use]
pub fn canary_is_alive() -> bool {
    // SAFETY: the word lies in memory and no variable of Rust is there.
    unsafe { (&raw const __stack_bottom).read_volatile() == PAINT }
}

/// The most bytes of stack that were ever used, by the paint that is gone. Reads up to the whole stack: for reports, not for
/// each tick.
#[cfg(target_arch = "mips")]
#[must_use]
pub fn used_most() -> usize {
    let top = (&raw const __stack_top).addr();
    let mut word = &raw const __stack_bottom;
    // SAFETY: reads words of memory between the two symbols, where no variable of Rust lies below the stack pointer.
    while word.addr() < top && unsafe { word.read_volatile() } == PAINT {
        word = ptr::with_exposed_provenance(word.addr() + size_of::<u32>());
    }
    top - word.addr()
}

/// On a machine that is no MIPS there is no such stack: 0 bytes.
#[cfg(not(target_arch = "mips"))]
#[must_use]
pub fn size() -> usize {
    0
}

/// On a machine that is no MIPS there is no such stack: it is never overrun.
#[cfg(not(target_arch = "mips"))]
#[must_use]
pub fn canary_is_alive() -> bool {
    true
}

/// On a machine that is no MIPS there is no such stack: 0 bytes.
#[cfg(not(target_arch = "mips"))]
#[must_use]
pub fn used_most() -> usize {
    0
}
