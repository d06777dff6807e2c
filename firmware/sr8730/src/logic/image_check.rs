//! Checks that flash still holds the image (S21).
//!
//! `cargo xtask firmware` writes two checksums behind the image: the CRC-32C of program flash and of boot flash. The start-up
//! code checks both before the first motor may move. The main loop checks them again, a few bytes each millisecond, so
//! that a flipped bit is found within ten seconds.

use rvac_protocol::crc::crc32c;

/// Pieces of an image: program flash and boot flash.
pub const PIECES: usize = 2;
/// Content of the check words in an image without checksums.
pub const NO_CRC: [u32; PIECES] = [u32::MAX; PIECES];
/// Bytes checked in one millisecond.
const SLICE_BYTES: usize = 16;

/// Result of the check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageState {
    /// No fault so far.
    Whole,
    /// The image differs from its checksum.
    Damaged,
    /// The image has no checksum: it was not made by `cargo xtask firmware`.
    Unchecked,
}

/// Checks the image repeatedly.
#[derive(Clone, Copy, Debug)]
pub struct ImageCheck<'a> {
    pieces: [(&'a [u8], u32); PIECES],
    piece: usize,
    place: usize,
    register: u32,
}

impl<'a> ImageCheck<'a> {
    /// Of these pieces, with their check values. Another number of words counts as none.
    #[must_use]
    pub fn new(flash: [&'a [u8]; PIECES], words: &[u32]) -> Self {
        let words = words.first_chunk().copied().unwrap_or(NO_CRC);
        let [program, boot] = flash;
        let [program_check, boot_check] = words;
        Self {
            pieces: [(program, program_check), (boot, boot_check)],
            piece: 0,
            place: 0,
            register: u32::MAX,
        }
    }

    /// Checks everything at once.
    #[must_use]
    pub fn all(&self) -> ImageState {
        if self.pieces.iter().map(|(_, check)| *check).eq(NO_CRC) {
            return ImageState::Unchecked;
        }
        let whole = self
            .pieces
            .iter()
            .all(|(bytes, check)| !crc32c(u32::MAX, bytes) == *check);
        if whole {
            ImageState::Whole
        } else {
            ImageState::Damaged
        }
    }

    /// Checks the next few bytes. [`Self::all`] detects an image without checksums.
    pub fn slice(&mut self) -> ImageState {
        let Some((bytes, check)) = self.pieces.get(self.piece).copied() else {
            self.piece = 0;
            return ImageState::Whole;
        };
        let rest = bytes.get(self.place..).unwrap_or_default();
        if rest.is_empty() {
            let whole = !self.register == check;
            self.piece += 1;
            self.place = 0;
            self.register = u32::MAX;
            return if whole {
                ImageState::Whole
            } else {
                ImageState::Damaged
            };
        }
        let slice = rest.get(..SLICE_BYTES).unwrap_or(rest);
        self.register = crc32c(self.register, slice);
        self.place += slice.len();
        ImageState::Whole
    }
}

#[cfg(test)]
mod tests {
    use super::{ImageCheck, ImageState, NO_CRC};
    use rvac_protocol::crc::crc32c;
    use std::vec::Vec;

    fn flash() -> [Vec<u8>; 2] {
        let bytes = |length: u32, step: u32| (0..length).map(|place| ((place * step) >> 3) as u8).collect();
        [bytes(1_000, 37), bytes(33, 201)]
    }

    fn check_of<'a>(flash: &'a [Vec<u8>; 2], written: &[Vec<u8>; 2]) -> ImageCheck<'a> {
        let words = [&written[0], &written[1]].map(|piece| !crc32c(u32::MAX, piece));
        ImageCheck::new([&flash[0], &flash[1]], &words)
    }

    #[test]
    fn an_image_with_its_crcs_is_whole_round_after_round() {
        let flash = flash();
        let mut check = check_of(&flash, &flash);
        assert_eq!(check.all(), ImageState::Whole);
        for _ in 0..1_000 {
            assert_eq!(check.slice(), ImageState::Whole);
        }
    }

    #[test]
    fn a_flipped_bit_anywhere_is_found_at_once_and_within_one_round() {
        for (piece, place) in [(0, 0), (0, 17), (0, 999), (1, 0), (1, 32)] {
            let mut damaged = flash();
            damaged[piece][place] ^= 0x10;
            let sound = flash();
            let mut check = check_of(&damaged, &sound);
            assert_eq!(check.all(), ImageState::Damaged);
            // 63 and 3 slices, two ends of a piece, and the turn to the first one.
            let found = (0..69).any(|_| check.slice() == ImageState::Damaged);
            assert!(found, "{piece} {place}");
        }
    }

    #[test]
    fn an_image_without_check_values_says_so() {
        let flash = flash();
        for words in [&NO_CRC[..], &[], &[7]] {
            let check = ImageCheck::new([&flash[0], &flash[1]], words);
            assert_eq!(check.all(), ImageState::Unchecked);
        }
    }
}
