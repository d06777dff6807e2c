//! A quick check of the whole image, twenty times a second.
//!
//! The CRC of the image takes too long to be computed often. Code that a flipped bit has changed can switch on a motor
//! at once, and must be found before the watchdog's time has passed. Therefore sums of blocks are taken at the start,
//! after the image was found intact, and one block is summed up again each millisecond. A sum detects every single-bit
//! error.

/// Words of a block: 3 KiB.
pub const BLOCK_WORDS: u32 = 768;
/// Most blocks: 192 KiB.
const BLOCKS: usize = 64;

/// Sums of all blocks.
#[derive(Clone, Copy, Debug)]
pub struct ImageSums {
    words: u32,
    next: u32,
    sums: [u32; BLOCKS],
}

/// The sum of a block.
#[must_use]
pub fn sum(words: impl Iterator<Item = u32>) -> u32 {
    words.fold(0, |sum: u32, word| sum.rotate_left(1).wrapping_add(word))
}

impl ImageSums {
    /// Of an image of so many words. `block` gives the sum of so many words from a word on.
    #[must_use]
    pub fn new(words: u32, block: impl Fn(u32, u32) -> u32) -> Self {
        let mut sums = Self {
            words,
            next: 0,
            sums: [0; BLOCKS],
        };
        for (first, place) in (0..words).step_by(BLOCK_WORDS as usize).zip(&mut sums.sums) {
            *place = block(first, BLOCK_WORDS.min(words - first));
        }
        sums
    }

    /// Looks at the next block; false if it has changed.
    #[must_use]
    pub fn is_next_whole(&mut self, block: impl Fn(u32, u32) -> u32) -> bool {
        let first = self.next;
        let left = self.words.saturating_sub(first);
        let known = self.sums.get((first / BLOCK_WORDS) as usize);
        match known {
            Some(known) if left > 0 => {
                self.next = first + BLOCK_WORDS;
                block(first, BLOCK_WORDS.min(left)) == *known
            }
            _ => {
                self.next = 0;
                true
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{BLOCK_WORDS, ImageSums, sum};
    use std::vec::Vec;

    const WORDS: u32 = 3 * BLOCK_WORDS + 100;

    fn image() -> Vec<u32> {
        (0..WORDS).map(|place| place.wrapping_mul(0x9E37_79B9)).collect()
    }

    fn block(image: &[u32]) -> impl Fn(u32, u32) -> u32 + '_ {
        |first, count| sum(image.iter().skip(first as usize).take(count as usize).copied())
    }

    #[test]
    fn a_sound_image_stays_whole() {
        let image = image();
        let mut sums = ImageSums::new(WORDS, block(&image));
        for _ in 0..100 {
            assert!(sums.is_next_whole(block(&image)));
        }
    }

    #[test]
    fn every_bit_of_a_word_is_noticed_within_one_round() {
        let sound = image();
        let sums = ImageSums::new(WORDS, block(&sound));
        for place in [0, 767, 768, 1_500, WORDS - 1] {
            for bit in 0..32 {
                let mut damaged = sound.clone();
                damaged[place as usize] ^= 1 << bit;
                let mut sums = sums;
                let found = (0..5).any(|_| !sums.is_next_whole(block(&damaged)));
                assert!(found, "word {place} bit {bit}");
            }
        }
    }

    #[test]
    fn words_that_change_places_are_noticed() {
        assert_ne!(sum([1, 2, 3].into_iter()), sum([2, 1, 3].into_iter()));
    }
}
