//! RAM and program flash as words, for self-tests.

use crate::cpu;

/// Start of RAM and of program flash as the processor sees them cached (section 2).
const RAM_BASE: u32 = 0x8000_0000;
const FLASH_BASE: u32 = 0x9D00_0000;

/// Bytes of RAM, as the chip says (BMXDRMSZ).
#[must_use]
pub fn ram_size() -> u32 {
    crate::register::map::BMXDRMSZ.read()
}

/// Bytes of program flash, as the chip says (BMXPFMSZ).
#[must_use]
pub fn flash_size() -> u32 {
    crate::register::map::BMXPFMSZ.read()
}

/// The identity of the chip: bits 27:0 are its kind (0x0934053 for the PIC32MX360F256L), bits 31:28 its revision.
#[must_use]
pub fn device_identity() -> u32 {
    crate::register::map::DEVID.read()
}

/// The word of RAM at `offset` bytes from its start; `None` outside of it or when unaligned.
#[must_use]
pub fn ram_word(offset: u32) -> Option<u32> {
    within(offset, ram_size()).then(|| access::load(RAM_BASE + offset))
}

/// The word of program flash at `offset` bytes from its start; `None` outside of it or when unaligned.
#[must_use]
pub fn flash_word(offset: u32) -> Option<u32> {
    within(offset, flash_size()).then(|| access::load(FLASH_BASE + offset))
}

/// Words of program flash from `offset` bytes on, `count` of them at most; none outside of it or when unaligned.
pub fn flash_words(offset: u32, count: u32) -> impl Iterator<Item = u32> {
    let size = flash_size();
    let aligned = offset.is_multiple_of(4);
    (0..count)
        .map(move |index| offset.saturating_add(index.saturating_mul(4)))
        .take_while(move |at| aligned && *at < size)
        .map(|at| access::load(FLASH_BASE + at))
}

/// Tests one word of RAM in place: each bit can be 0 and 1, whatever its neighbours in the word are. Its content is the same
/// afterwards. Interrupts are off for about 30 cycles, so that nobody sees it meanwhile. `None` outside of RAM or when
/// unaligned.
///
/// Called for each word in turn, in slices; a word of the stack or of a variable may be tested at any time.
#[must_use]
pub fn test_ram_word(offset: u32) -> Option<bool> {
    within(offset, ram_size()).then(|| access::test(RAM_BASE + offset))
}

fn within(offset: u32, size: u32) -> bool {
    offset < size && offset.is_multiple_of(4)
}

/// What the linker knows of the image.
pub mod image {
    /// Bytes of program flash from its start that the image fills, a multiple of four: vectors, code, constants and initial
    /// values of variables, without the seal.
    #[must_use]
    pub fn size() -> u32 {
        super::access::image_size()
    }

    /// The word behind the image, at offset [`size`]: a place for its check, which whoever writes the image file may fill.
    /// All ones when nobody did.
    #[must_use]
    pub fn seal() -> Option<u32> {
        super::flash_word(size())
    }
}

#[cfg(target_arch = "mips")]
mod access {
    use super::cpu;
    use core::ptr;

    #[inline(always)]
    pub(super) fn load(address: u32) -> u32 {
        // SAFETY: the callers check that the address lies in RAM or flash and is aligned. Any bits are a u32.
        unsafe { ptr::with_exposed_provenance::<u32>(address as usize).read_volatile() }
    }

    pub(super) fn test(address: u32) -> bool {
        let word = ptr::with_exposed_provenance_mut::<u32>(address as usize);
        cpu::without_interrupts(|| {
            // SAFETY: the caller checks that the address lies in RAM and is aligned. The word has its old value when
            // interrupts come on, and this closure keeps its own variables in registers or has written them before: the
            // accesses are volatile and in this order, and the pattern that is read back was written just before.
            unsafe {
                let content = word.read_volatile();
                let mut good = true;
                for pattern in [!content, 0x5555_5555, 0xAAAA_AAAA, content] {
                    word.write_volatile(pattern);
                    good &= word.read_volatile() == pattern;
                }
                good
            }
        })
    }

    pub(super) fn image_size() -> u32 {
        unsafe extern "C" {
            static __image_seal: u32;
        }
        (&raw const __image_seal).addr() as u32 - super::FLASH_BASE
    }
}

#[cfg(not(target_arch = "mips"))]
mod access {
    pub(super) fn load(_address: u32) -> u32 {
        u32::MAX
    }

    pub(super) fn test(_address: u32) -> bool {
        super::cpu::without_interrupts(|| true)
    }

    pub(super) fn image_size() -> u32 {
        0
    }
}
