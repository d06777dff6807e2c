//! Whether program flash still holds what was written to it (S21).
//!
//! `cargo xtask firmware` puts the CRC-32C of the image behind its last word. The start-up code checks all of it before
//! the first motor may move, and the main loop goes over it again, a few words in each millisecond, so that a bit that
//! flips later is noticed within ten seconds.

use rvac_protocol::seal::crc32c;

/// What stands in place of the check value when nobody has written one.
const UNSEALED: u32 = u32::MAX;
/// Words checked in one millisecond.
const SLICE_WORDS: u32 = 4;

/// What the checks have found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing wrong so far.
    Whole,
    /// The image differs from its check value.
    Damaged,
    /// The image carries no check value: it was not made by `cargo xtask firmware`.
    Unsealed,
}

/// Goes over the image again and again.
#[derive(Clone, Copy, Debug)]
pub struct ImageCheck {
    size_bytes: u32,
    expected: u32,
    place: u32,
    register: u32,
}

impl ImageCheck {
    /// Of an image of so many bytes, a multiple of four, with this check value.
    #[must_use]
    pub const fn new(size_bytes: u32, expected: u32) -> Self {
        Self {
            size_bytes,
            expected,
            place: 0,
            register: u32::MAX,
        }
    }

    /// Checks everything at once. `read` gives the word at an offset.
    #[must_use]
    pub fn all(&self, read: impl Fn(u32) -> Option<u32>) -> Verdict {
        if self.expected == UNSEALED {
            return Verdict::Unsealed;
        }
        let mut register = u32::MAX;
        let mut place = 0;
        while place < self.size_bytes {
            register = crc32c(register, &read(place).unwrap_or(0).to_le_bytes());
            place += 4;
        }
        self.judge(register)
    }

    /// Checks the next few words. An image without check value is found by [`Self::all`].
    pub fn slice(&mut self, read: impl Fn(u32) -> Option<u32>) -> Verdict {
        let end = self.size_bytes.min(self.place + 4 * SLICE_WORDS);
        while self.place < end {
            self.register = crc32c(self.register, &read(self.place).unwrap_or(0).to_le_bytes());
            self.place += 4;
        }
        if self.place < self.size_bytes {
            return Verdict::Whole;
        }
        let verdict = self.judge(self.register);
        self.place = 0;
        self.register = u32::MAX;
        verdict
    }

    const fn judge(&self, register: u32) -> Verdict {
        if !register == self.expected {
            Verdict::Whole
        } else {
            Verdict::Damaged
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ImageCheck, Verdict};
    use rvac_protocol::seal::crc32c;
    use std::vec::Vec;

    fn image() -> Vec<u32> {
        (0..101_u32)
            .map(|place| place.wrapping_mul(0x9E37_79B9))
            .collect()
    }

    fn check_of(image: &[u32]) -> ImageCheck {
        let bytes: Vec<u8> = image.iter().flat_map(|word| word.to_le_bytes()).collect();
        ImageCheck::new(u32::try_from(bytes.len()).unwrap(), !crc32c(u32::MAX, &bytes))
    }

    fn reader(image: &[u32]) -> impl Fn(u32) -> Option<u32> + '_ {
        |offset| image.get(offset as usize / 4).copied()
    }

    #[test]
    fn a_sealed_image_is_whole_round_after_round() {
        let image = image();
        let mut check = check_of(&image);
        assert_eq!(check.all(reader(&image)), Verdict::Whole);
        for _ in 0..1_000 {
            assert_eq!(check.slice(reader(&image)), Verdict::Whole);
        }
    }

    #[test]
    fn a_flipped_bit_anywhere_is_found_at_once_and_within_one_round() {
        for place in [0, 1, 50, 100] {
            let mut check = check_of(&image());
            let mut damaged = image();
            damaged[place] ^= 0x10;
            assert_eq!(check.all(reader(&damaged)), Verdict::Damaged);
            let found = (0..26).any(|_| check.slice(reader(&damaged)) == Verdict::Damaged);
            assert!(found, "{place}");
        }
    }

    #[test]
    fn an_image_without_check_value_says_so() {
        let image = image();
        let check = ImageCheck::new(404, u32::MAX);
        assert_eq!(check.all(reader(&image)), Verdict::Unsealed);
    }
}
