//! Writing program flash: only the pages that the linker script keeps for data (section 16).
//!
//! While the controller works the processor stalls, because it runs from the same flash: 20 ms for a page, some tens
//! of microseconds for a word. So nothing must move while it is used. Erased flash is all ones; a word is programmed once.

use crate::cpu;
use crate::register::map::{NVMADDR, NVMCON, NVMDATA, NVMKEY};

/// Bytes of a page, the least that can be erased. The number has one source.
pub const PAGE_BYTES: u32 = 4096;

const PROGRAM_WORD: u32 = 1;
const ERASE_PAGE: u32 = 4;
const ENABLE: u32 = 1 << 14;
const BUSY: u32 = 1 << 15;
const FAILED: u32 = 0x3000;
const FIRST_KEY: u32 = 0xAA99_6655;
const SECOND_KEY: u32 = 0x5566_99AA;
/// The low-voltage detector needs 6 us; 1000 counts are 12.5 us at the fastest clock.
const DETECTOR_COUNTS: u32 = 1_000;
const FLASH_PHYSICAL: u32 = 0x1D00_0000;

/// Why nothing was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashError {
    /// The place lies outside of the data pages, or is not aligned.
    Place,
    /// The controller reported an error, usually a low supply.
    Controller,
    /// What was written reads otherwise.
    Verify,
}

/// The pages for data.
#[derive(Debug)]
pub struct DataFlash(());

impl DataFlash {
    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Bytes that there are.
    #[must_use]
    pub fn size(&self) -> u32 {
        place::end() - place::start()
    }

    /// The word at `offset` bytes from the start of the data pages; `None` outside or when unaligned.
    #[must_use]
    pub fn word(&self, offset: u32) -> Option<u32> {
        if offset >= self.size() {
            return None;
        }
        crate::memory::flash_word(place::start() + offset)
    }

    /// Erases the page that begins at `offset` bytes.
    ///
    /// # Errors
    /// [`FlashError`]; the page may be partly erased when it is not [`FlashError::Place`].
    pub fn erase_page(&mut self, offset: u32) -> Result<(), FlashError> {
        if !offset.is_multiple_of(PAGE_BYTES) || offset >= self.size() {
            return Err(FlashError::Place);
        }
        operate(ERASE_PAGE, place::start() + offset)?;
        let erased =
            crate::memory::flash_words(place::start() + offset, PAGE_BYTES / 4).all(|word| word == u32::MAX);
        if erased { Ok(()) } else { Err(FlashError::Verify) }
    }

    /// Programs the erased word at `offset` bytes.
    ///
    /// # Errors
    /// [`FlashError`]
    pub fn program_word(&mut self, offset: u32, word: u32) -> Result<(), FlashError> {
        if !offset.is_multiple_of(4) || offset >= self.size() {
            return Err(FlashError::Place);
        }
        NVMDATA.write(word);
        operate(PROGRAM_WORD, place::start() + offset)?;
        if self.word(offset) == Some(word) {
            Ok(())
        } else {
            Err(FlashError::Verify)
        }
    }
}

/// `offset` is in bytes from the start of program flash and was checked to be in the data pages.
fn operate(operation: u32, offset: u32) -> Result<(), FlashError> {
    cpu::without_interrupts(|| {
        NVMADDR.write(FLASH_PHYSICAL + offset);
        NVMCON.write(ENABLE | operation);
        let begun = cpu::count();
        while cpu::count().wrapping_sub(begun) < DETECTOR_COUNTS {}
        NVMKEY.write(FIRST_KEY);
        NVMKEY.write(SECOND_KEY);
        NVMCON.set(BUSY);
        while NVMCON.has(BUSY) {}
        NVMCON.clear(ENABLE);
    });
    if NVMCON.read() & FAILED == 0 {
        Ok(())
    } else {
        Err(FlashError::Controller)
    }
}

/// Where the data pages are, in bytes from the start of program flash (link.x).
#[cfg(target_arch = "mips")]
mod place {
    unsafe extern "C" {
        static __data_pages_start: u32;
        static __data_pages_end: u32;
    }
    const FLASH_BASE: u32 = 0x9D00_0000;

    pub(super) fn start() -> u32 {
        (&raw const __data_pages_start).addr() as u32 - FLASH_BASE
    }

    pub(super) fn end() -> u32 {
        (&raw const __data_pages_end).addr() as u32 - FLASH_BASE
    }
}

#[cfg(not(target_arch = "mips"))]
mod place {
    pub(super) fn start() -> u32 {
        0
    }

    pub(super) fn end() -> u32 {
        0
    }
}
