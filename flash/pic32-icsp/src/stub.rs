//! The program in RAM: how it gets there, and how it is asked.

use crate::error::IcspError;
use crate::image::{ROW_BYTES, word_of};
use crate::pins::IcspPins;
use crate::test_port::TestPort;

include!(concat!(env!("OUT_DIR"), "/stub_words.rs"));

/// Where both programs lie; the sources name the stub's place, too.
const LOADER_PLACE: u32 = 0xA000_0800;
const STUB_PLACE: u32 = 0xA000_0900;

/// The bus matrix, and what the stub needs of it: RAM from 2 KiB on may be executed.
const BMXCON: (u32, u32) = (0xBF88_2000, 0x001F_0040);
const BMXDKPBA: (u32, u32) = (0xBF88_2010, 0x0000_0800);
const BMXDUDBA: (u32, u32) = (0xBF88_2020, 0x0000_8000);
const BMXDUPBA: (u32, u32) = (0xBF88_2030, 0x0000_8000);

const READ: u32 = 0;
const ROW: u32 = 1;
const ERASE: u32 = 2;
const FINISH: u32 = 3;
/// WRERR and LVDERR of NVMCON.
const FAILED: u32 = 0x3000;

/// Why the stub did not do what it was asked.
#[derive(Debug)]
pub(crate) enum StubFault<E> {
    /// A word was lost or wrong: enter again and repeat.
    Lost,
    /// NVMCON of the operation before.
    Flash(u32),
    /// No use in repeating.
    Icsp(IcspError<E>),
}

impl<E> From<IcspError<E>> for StubFault<E> {
    fn from(error: IcspError<E>) -> Self {
        Self::Icsp(error)
    }
}

/// Both sums of words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Sums {
    first: u32,
    second: u32,
}

impl Sums {
    fn add(&mut self, word: u32) {
        self.first = self.first.wrapping_add(word);
        self.second = self.second.wrapping_add(self.first);
    }
}

impl<P: IcspPins> TestPort<'_, P> {
    /// Puts the stub into RAM, starts it, and compares what is there. The core is in debug mode.
    pub(crate) fn start_stub(&mut self) -> Result<(), StubFault<P::Error>> {
        for (address, value) in [BMXCON, BMXDKPBA, BMXDUDBA, BMXDUPBA] {
            self.store(address, value)?;
        }
        for (index, word) in LOADER.iter().enumerate() {
            self.store(LOADER_PLACE + 4 * index as u32, *word)?;
        }
        self.jump(LOADER_PLACE)?;
        self.exchange(STUB.len() as u32)?;
        for word in STUB {
            self.exchange(word)?;
        }
        let mut found = [0; STUB.len() * 4];
        self.read_by_stub(STUB_PLACE, &mut found)?;
        let is_whole = found.chunks(4).map(word_of).eq(STUB);
        if is_whole { Ok(()) } else { Err(StubFault::Lost) }
    }

    fn exchange(&mut self, word: u32) -> Result<u32, StubFault<P::Error>> {
        self.fast(word)?.ok_or(StubFault::Lost)
    }

    fn command(&mut self, command: u32, argument: u32) -> Result<(), StubFault<P::Error>> {
        for word in [command, argument, !(command ^ argument)] {
            self.exchange(word)?;
        }
        Ok(())
    }

    /// Reads from a virtual address; the length is a multiple of four, and not zero.
    pub(crate) fn read_by_stub(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), StubFault<P::Error>> {
        self.command(address | READ, bytes.len() as u32 / 4)?;
        let mut sums = Sums::default();
        for place in bytes.chunks_exact_mut(4) {
            let word = self.exchange(0)?;
            sums.add(word);
            place.copy_from_slice(&word.to_le_bytes());
        }
        let found = Sums {
            first: self.exchange(0)?,
            second: self.exchange(0)?,
        };
        if found == sums {
            Ok(())
        } else {
            Err(StubFault::Lost)
        }
    }

    /// Begins to erase the page at a physical address.
    pub(crate) fn begin_erasure(&mut self, address: u32) -> Result<(), StubFault<P::Error>> {
        self.command(address | ERASE, 0)?;
        self.judge_last()
    }

    /// Begins to program the row at a physical address.
    pub(crate) fn begin_row(&mut self, address: u32, row: &[u8]) -> Result<(), StubFault<P::Error>> {
        debug_assert_eq!(row.len(), ROW_BYTES);
        let mut sums = Sums::default();
        for bytes in row.chunks_exact(4) {
            sums.add(word_of(bytes));
        }
        self.command(address | ROW, sums.second)?;
        for bytes in row.chunks_exact(4) {
            self.exchange(word_of(bytes))?;
        }
        self.judge_last()
    }

    /// Waits for what was begun.
    pub(crate) fn finish_flash(&mut self) -> Result<(), StubFault<P::Error>> {
        self.command(FINISH, 0)?;
        self.judge_last()
    }

    fn judge_last(&mut self) -> Result<(), StubFault<P::Error>> {
        let control = self.exchange(0)?;
        // Bits that NVMCON does not have: the answer itself was read wrongly.
        if control & !0x0000_F80F != 0 {
            return Err(StubFault::Lost);
        }
        match control & FAILED {
            0 => Ok(()),
            _ => Err(StubFault::Flash(control)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LOADER, STUB};

    /// The words that the reference gives for the same instructions, assembled with binutils.
    #[test]
    fn the_build_assembles_as_binutils_do() {
        assert_eq!(
            STUB[..5],
            [0x3C13_FF20, 0x3C14_BF81, 0x3C15_A000, 0x36B5_1000, 0x340D_4000]
        );
        assert_eq!(LOADER[0], 0x3C13_FF20);
        // `lui t6, 0xaa99`, `ori t7, zero, 0x4003` and 0x4004.
        for known in [0x3C0E_AA99, 0x340F_4003, 0x340F_4004] {
            assert!(STUB.contains(&known), "{known:#010x}");
        }
        // The last instruction leads to itself, with its slot.
        assert_eq!(STUB[STUB.len() - 2..], [0x1000_FFFF, 0]);
    }

    #[test]
    fn both_programs_end_before_the_next_place() {
        assert!(LOADER.len() * 4 <= 0x100);
        assert!(STUB.len() * 4 <= 0x700, "the row buffers begin at 0x1000");
    }
}
