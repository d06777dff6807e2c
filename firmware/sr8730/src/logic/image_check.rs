//! Whether program flash still holds what was written to it (S21).
//!
//! `cargo xtask firmware` writes a seal into the image: for each of its pieces the length and the CRC-32C. The start-up code
//! checks all of it before the first motor may move, and the main loop goes over it again, a few bytes in each
//! millisecond, so that a bit that flips later is noticed within a quarter of a minute.

use rvac_protocol::seal::crc32c;

/// First word of the seal.
pub const SEAL_MAGIC: u32 = 0x4C41_4553;
/// Pieces of an image: boot flash, and program flash before and after the seal.
pub const PIECES: usize = 3;
/// Words of the seal: the magic, and length and CRC of each piece.
pub const SEAL_WORDS: usize = 1 + 2 * PIECES;

/// Bytes checked in one millisecond.
const SLICE_BYTES: usize = 16;

/// What the checks have found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing wrong so far.
    Whole,
    /// The image differs from its seal.
    Damaged,
    /// The image carries no seal: it was not made by `cargo xtask firmware`.
    Unsealed,
}

/// Goes over the image again and again.
#[derive(Clone, Copy, Debug)]
pub struct ImageCheck<'a> {
    pieces: [(&'a [u8], u32); PIECES],
    piece: usize,
    place: usize,
    register: u32,
}

impl<'a> ImageCheck<'a> {
    /// Takes the seal and the bytes from the start of each piece on.
    ///
    /// # Errors
    /// [`Verdict::Unsealed`] without a seal, [`Verdict::Damaged`] if a piece is shorter than the seal says.
    pub fn new(seal: &[u32; SEAL_WORDS], flash: [&'a [u8]; PIECES]) -> Result<Self, Verdict> {
        let [magic, facts @ ..] = seal;
        if *magic != SEAL_MAGIC {
            return Err(Verdict::Unsealed);
        }
        let mut pieces: [(&[u8], u32); PIECES] = [(&[], 0); PIECES];
        for ((piece, bytes), [length, crc]) in pieces.iter_mut().zip(flash).zip(facts.as_chunks::<2>().0) {
            *piece = (bytes.get(..*length as usize).ok_or(Verdict::Damaged)?, *crc);
        }
        Ok(Self {
            pieces,
            piece: 0,
            place: 0,
            register: u32::MAX,
        })
    }

    /// Checks everything at once.
    #[must_use]
    pub fn all(&self) -> Verdict {
        let whole = self
            .pieces
            .iter()
            .all(|(bytes, crc)| !crc32c(u32::MAX, bytes) == *crc);
        if whole { Verdict::Whole } else { Verdict::Damaged }
    }

    /// Checks the next few bytes.
    pub fn slice(&mut self) -> Verdict {
        let Some((bytes, crc)) = self.pieces.get(self.piece).copied() else {
            self.piece = 0;
            return Verdict::Whole;
        };
        let rest = bytes.get(self.place..).unwrap_or_default();
        if rest.is_empty() {
            let whole = !self.register == crc;
            self.piece += 1;
            self.place = 0;
            self.register = u32::MAX;
            return if whole { Verdict::Whole } else { Verdict::Damaged };
        }
        let slice = rest.get(..SLICE_BYTES).unwrap_or(rest);
        self.register = crc32c(self.register, slice);
        self.place += slice.len();
        Verdict::Whole
    }
}

#[cfg(test)]
mod tests {
    use super::{ImageCheck, SEAL_MAGIC, Verdict};
    use rvac_protocol::seal::crc32c;
    use std::vec::Vec;

    fn flash() -> [Vec<u8>; 3] {
        let bytes = |length: u32, step: u32| (0..length).map(|place| (place * step >> 3) as u8).collect();
        [bytes(100, 7), bytes(1_000, 37), bytes(33, 201)]
    }

    fn seal(flash: &[Vec<u8>; 3]) -> [u32; 7] {
        let mut seal = [SEAL_MAGIC; 7];
        for (place, piece) in flash.iter().enumerate() {
            seal[1 + 2 * place] = u32::try_from(piece.len()).unwrap();
            seal[2 + 2 * place] = !crc32c(u32::MAX, piece);
        }
        seal
    }

    fn pieces(flash: &[Vec<u8>; 3]) -> [&[u8]; 3] {
        [&flash[0], &flash[1], &flash[2]]
    }

    #[test]
    fn a_sealed_image_is_whole_round_after_round() {
        let flash = flash();
        let mut check = ImageCheck::new(&seal(&flash), pieces(&flash)).unwrap();
        assert_eq!(check.all(), Verdict::Whole);
        for _ in 0..1_000 {
            assert_eq!(check.slice(), Verdict::Whole);
        }
    }

    #[test]
    fn a_flipped_bit_anywhere_is_found_at_once_and_within_one_round() {
        let seal = seal(&flash());
        for (piece, place) in [(0, 0), (0, 99), (1, 17), (1, 999), (2, 32)] {
            let mut damaged = flash();
            damaged[piece][place] ^= 0x10;
            let mut check = ImageCheck::new(&seal, pieces(&damaged)).unwrap();
            assert_eq!(check.all(), Verdict::Damaged);
            // 7 + 63 + 3 slices, three ends of a piece, and the turn to the first one.
            let found = (0..77).any(|_| check.slice() == Verdict::Damaged);
            assert!(found, "{piece} {place}");
        }
    }

    #[test]
    fn no_seal_and_a_seal_beyond_the_flash_are_refused() {
        let flash = flash();
        let unsealed = ImageCheck::new(&[u32::MAX; 7], pieces(&flash));
        assert_eq!(unsealed.err(), Some(Verdict::Unsealed));
        let mut too_long = seal(&flash);
        too_long[3] += 1;
        let refused = ImageCheck::new(&too_long, pieces(&flash));
        assert_eq!(refused.err(), Some(Verdict::Damaged));
    }
}
