//! The record that outlives a reset: in the firmware's memory by callbacks, else in that of the process.

use cord::board::{KEPT_WORDS, KeptMemory, KeptWords};
use rvac_protocol::crc::crc32c;

use crate::board::Foreign;
use crate::callbacks::{CORD_KEPT_WORDS, callbacks};
use crate::machine::machine;

/// Words of a copy: the record and its check.
const COPY_WORDS: i32 = KEPT_WORDS as i32 + 1;
const _: () = assert!(2 * COPY_WORDS == CORD_KEPT_WORDS);

impl KeptMemory for Foreign {
    const PRESENT: bool = true;

    fn load(&mut self) -> Option<KeptWords> {
        let Some(kept) = callbacks().kept else {
            return machine().kept;
        };
        [0, COPY_WORDS].into_iter().find_map(|start| {
            let mut words = [0; KEPT_WORDS];
            for (place, word) in (start..).zip(&mut words) {
                *word = kept(place);
            }
            (kept(start + COPY_WORDS - 1) == check_of(&words)).then_some(words)
        })
    }

    fn store(&mut self, words: &KeptWords) {
        machine().kept = Some(*words);
        let Some(keep) = callbacks().keep else {
            return;
        };
        for start in [0, COPY_WORDS] {
            for (place, word) in (start..).zip(words) {
                keep(place, *word);
            }
            keep(start + COPY_WORDS - 1, check_of(words));
        }
    }
}

/// CRC-32C of the words, lowest byte first.
fn check_of(words: &KeptWords) -> u32 {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes());
    !crc32c(u32::MAX, &bytes.collect::<Vec<u8>>())
}
