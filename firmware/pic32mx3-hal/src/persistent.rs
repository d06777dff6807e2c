//! Words that a reset leaves alone, as long as the chip has power.

use crate::cpu;
use core::cell::UnsafeCell;
use core::fmt;
use core::mem::MaybeUninit;

/// `N` words and a check. Put it in a `static` in the section `.noinit`, which the start-up code does not touch:
///
/// ```
/// use pic32mx3_hal::persistent::Persistent;
///
/// #[cfg_attr(target_arch = "mips", unsafe(link_section = ".noinit"))]
/// static STARTS: Persistent<1> = Persistent::uninitialised();
///
/// let [starts] = STARTS.load().unwrap_or([0]);
/// STARTS.store([starts + 1]);
/// assert_eq!(STARTS.load(), Some([1]));
/// ```
///
/// After power-on the memory holds anything; the check then fails but for one case in 2^32.
pub struct Persistent<const N: usize> {
    cell: UnsafeCell<MaybeUninit<Words<N>>>,
}

/// The words and, behind them, their check.
#[repr(C)]
struct Words<const N: usize> {
    words: [u32; N],
    check: u32,
}

// SAFETY: each access is whole, with interrupts off, on the only core.
unsafe impl<const N: usize> Sync for Persistent<N> {}

impl<const N: usize> Persistent<N> {
    /// Memory whose content comes from before the reset.
    #[must_use]
    pub const fn uninitialised() -> Self {
        Self {
            // Zeros, so that a machine which does initialise it has a defined value; their check does not hold.
            cell: UnsafeCell::new(MaybeUninit::zeroed()),
        }
    }

    /// What was stored last, or `None` when nothing was or it was damaged.
    pub fn load(&self) -> Option<[u32; N]> {
        let (words, check) = cpu::without_interrupts(|| {
            let mut words = [0; N];
            // SAFETY: interrupts are off, so no handler writes meanwhile; any bits are words. Volatile, because the compiler
            // assumes the initial zeros.
            unsafe {
                for (index, word) in words.iter_mut().enumerate() {
                    *word = self.words().add(index).read_volatile();
                }
                (words, self.words().add(N).read_volatile())
            }
        });
        (check == check_of(&words)).then_some(words)
    }

    /// Stores words.
    pub fn store(&self, words: [u32; N]) {
        self.put(words, check_of(&words));
    }

    /// Makes [`Self::load`] give `None`.
    pub fn forget(&self) {
        self.put([0; N], !check_of(&[0; N]));
    }

    fn put(&self, words: [u32; N], check: u32) {
        cpu::without_interrupts(|| {
            // SAFETY: interrupts are off, so no handler reads or writes meanwhile.
            unsafe {
                for (index, word) in words.iter().enumerate() {
                    self.words().add(index).write_volatile(*word);
                }
                self.words().add(N).write_volatile(check);
            }
        });
    }

    /// The first of `N` words and the check behind them.
    const fn words(&self) -> *mut u32 {
        self.cell.get().cast()
    }
}

impl<const N: usize> fmt::Debug for Persistent<N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("Persistent").field(&self.load()).finish()
    }
}

/// CRC-32C of the words, lowest bit first, inverted at both ends. Up to five changed bits always show.
const fn check_of<const N: usize>(words: &[u32; N]) -> u32 {
    const POLYNOMIAL_REVERSED: u32 = 0x82F6_3B78;
    let mut register = u32::MAX;
    let mut rest: &[u32] = words;
    while let [word, after @ ..] = rest {
        register ^= *word;
        let mut bit = 0;
        while bit < u32::BITS {
            let carry = POLYNOMIAL_REVERSED & (register & 1).wrapping_neg();
            register = (register >> 1) ^ carry;
            bit += 1;
        }
        rest = after;
    }
    !register
}

#[cfg(test)]
mod tests {
    use super::{Persistent, check_of};

    #[test]
    fn it_holds_nothing_until_something_was_stored_and_nothing_after_forgetting() {
        let memory: Persistent<3> = Persistent::uninitialised();
        assert_eq!(memory.load(), None);
        memory.store([1, 0, u32::MAX]);
        assert_eq!(memory.load(), Some([1, 0, u32::MAX]));
        memory.forget();
        assert_eq!(memory.load(), None);
    }

    /// The bytes 0 to 31: the value in RFC 3720, B.4.
    #[test]
    fn the_check_is_the_crc_of_the_standard() {
        let mut words = [0; 8];
        for (index, word) in (0_u32..).zip(words.iter_mut()) {
            *word = 0x0302_0100 + index * 0x0404_0404;
        }
        assert_eq!(check_of(&words), 0x46DD_794E);
    }

    #[test]
    fn every_single_bit_and_every_pair_of_bits_changes_the_check() {
        let words = [0x1234_5678, 0, u32::MAX];
        let check = check_of(&words);
        for first in 0..96_usize {
            for second in first..96 {
                let mut damaged = words;
                damaged[first / 32] ^= 1 << (first % 32);
                if second != first {
                    damaged[second / 32] ^= 1 << (second % 32);
                }
                assert_ne!(check_of(&damaged), check, "bits {first} and {second}");
            }
        }
    }
}
