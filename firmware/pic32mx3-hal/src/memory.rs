//! RAM and program flash as words, for self-tests.

use crate::cpu;

/// Start of RAM and of program flash at their cached addresses (section 2).
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
    let fitting = match offset.is_multiple_of(4) {
        true => flash_size().saturating_sub(offset) / 4,
        false => 0,
    };
    (0..count.min(fitting)).map(move |index| access::load(FLASH_BASE + offset + index * 4))
}

/// Tests one word of RAM in place: each bit can be 0 and 1, whatever its neighbours in the word are. Its content is the same
/// afterwards. Interrupts are off for about 30 cycles, so that no other code reads it meanwhile. `None` outside of RAM or when
/// unaligned.
///
/// While a DMA channel uses RAM, call it within [`crate::dma::suspended`]: the channel would see the patterns, or lose what it wrote.
///
/// Called for each word in turn, in slices; a word of the stack or of a variable may be tested at any time.
#[must_use]
pub fn test_ram_word(offset: u32) -> Option<bool> {
    within(offset, ram_size()).then(|| access::test(RAM_BASE + offset))
}

fn within(offset: u32, size: u32) -> bool {
    offset < size && offset.is_multiple_of(4)
}

/// Addresses of the image from the linker. All of it is constant memory.
pub mod image {
    use super::access;

    /// Program flash from its start to the check words: vectors, code, constants, initial values of variables.
    #[must_use]
    pub fn program() -> &'static [u8] {
        access::program()
    }

    /// Boot flash as far as the image fills it: the code that runs from reset to the program.
    #[must_use]
    pub fn boot() -> &'static [u8] {
        access::boot()
    }

    /// The words of [`image_crc!`](crate::image_crc!), as they are in flash now, which whoever writes the image file may
    /// have changed since the program was compiled. Empty without that macro.
    #[must_use]
    pub fn check_words() -> &'static [u32] {
        access::check_words()
    }

    /// Keeps words behind the image for a check of it: `image_crc!([0xFFFF_FFFF; 3]);`. Once in a program.
    #[macro_export]
    macro_rules! image_crc {
        ($words:expr) => {
            const _: () = {
                const WORDS: &[u32] = &$words;
                #[cfg_attr(target_arch = "mips", unsafe(link_section = ".image_crc"))]
                #[used]
                static CHECK_WORDS: [u32; WORDS.len()] = $words;
            };
        };
    }
}

#[cfg(target_arch = "mips")]
mod access {
    use super::cpu;
    use core::{ptr, slice};

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

    unsafe extern "C" {
        static __vectors: u8;
        static __boot_flash: u8;
        static __reset_end: u8;
        static __image_crc: u32;
        static __image_end: u32;
    }

    pub(super) fn program() -> &'static [u8] {
        let start = &raw const __vectors;
        let length = (&raw const __image_crc).addr() - start.addr();
        // SAFETY: the linker puts the check words behind the rest, both in program flash, whose content is constant: the module
        // `flash` writes to the data pages only.
        unsafe { slice::from_raw_parts(start, length) }
    }

    pub(super) fn boot() -> &'static [u8] {
        // The end is known in the uncached window, where the code runs.
        const UNCACHED: usize = 0x2000_0000;
        let start = &raw const __boot_flash;
        let length = (&raw const __reset_end).addr() - UNCACHED - start.addr();
        // SAFETY: as for `program`, in boot flash.
        unsafe { slice::from_raw_parts(start, length) }
    }

    pub(super) fn check_words() -> &'static [u32] {
        let start = &raw const __image_crc;
        let words = ((&raw const __image_end).addr() - start.addr()) / size_of::<u32>();
        // SAFETY: as for `program`; the linker script aligns it.
        unsafe { slice::from_raw_parts(start, words) }
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

    pub(super) fn program() -> &'static [u8] {
        &[]
    }

    pub(super) fn boot() -> &'static [u8] {
        &[]
    }

    pub(super) fn check_words() -> &'static [u32] {
        &[]
    }
}
