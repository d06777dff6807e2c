//! Work on bytes.

use crate::{Numbers, mix};
use core::fmt::Write;

/// CRC-32C bit by bit, as the wire protocol has it.
pub(crate) fn checksum(seed: u32) -> u32 {
    let mut numbers = Numbers::new(seed);
    let mut crc = u32::MAX;
    for _ in 0..200 {
        crc ^= numbers.next() & 0xFF;
        for _ in 0..8 {
            let carry = crc & 1;
            crc = crc >> 1 ^ 0x82F6_3B78 & carry.wrapping_neg();
        }
    }
    !crc
}

/// The sort of the standard library, and a search in its result.
pub(crate) fn sort(seed: u32) -> u32 {
    let mut numbers = Numbers::new(seed);
    let mut table = [0_i16; 300];
    table.fill_with(|| numbers.next() as i16);
    table.sort_unstable();
    let found = table.binary_search(&(seed as i16)).unwrap_or_else(|place| place);
    table
        .iter()
        .step_by(7)
        .fold(found as u32, |result, number| mix(result, *number as u32))
}

/// The compression function of SHA-256, without its constants: rotations and additions.
pub(crate) fn hash(seed: u32) -> u32 {
    let mut numbers = Numbers::new(seed);
    let mut state: [u32; 8] = core::array::from_fn(|_| numbers.next());
    for _ in 0..256 {
        let [a, b, c, d, e, f, g, h] = state;
        let upper = e.rotate_right(6) ^ e.rotate_right(11) ^ e.rotate_right(25);
        let choice = e & f ^ !e & g;
        let first = h
            .wrapping_add(upper)
            .wrapping_add(choice)
            .wrapping_add(numbers.next());
        let lower = a.rotate_right(2) ^ a.rotate_right(13) ^ a.rotate_right(22);
        let majority = a & b ^ a & c ^ b & c;
        let second = lower.wrapping_add(majority);
        state = [
            first.wrapping_add(second),
            a,
            b,
            c,
            d.wrapping_add(first),
            e,
            f,
            g,
        ];
    }
    state.iter().fold(0, |result, word| mix(result, *word))
}

/// Text that is checksummed while it is written.
struct Sink(u32);

impl Write for Sink {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        self.0 = text
            .bytes()
            .fold(self.0, |result, byte| mix(result, u32::from(byte)));
        Ok(())
    }
}

/// Formatted numbers, read back again.
pub(crate) fn text(seed: u32) -> u32 {
    let mut numbers = Numbers::new(seed);
    let mut sink = Sink(seed);
    for _ in 0..12 {
        let number = numbers.next();
        let wide = u64::from(number) << 13 ^ u64::from(seed);
        let written = write!(
            sink,
            "{number:#010x} {} {wide:>20} {:?}",
            number as i8,
            (seed, 'ß')
        );
        sink.0 = mix(sink.0, u32::from(written.is_ok()));
    }
    let parsed = "4000000000".parse::<u32>().unwrap_or(1) ^ "-77".parse::<i32>().unwrap_or(2) as u32;
    mix(sink.0, parsed)
}

/// Numbers at odd places, which the compiler moves by halves of words.
pub(crate) fn unaligned(seed: u32) -> u32 {
    let mut numbers = Numbers::new(seed);
    let mut bytes = [0_u8; 96];
    for place in (0..88).step_by(3) {
        let number = numbers.next();
        bytes[place..place + 4].copy_from_slice(&number.to_le_bytes());
        let wide = u64::from(number) * 0x1_0000_0001;
        bytes[place + 1..place + 9].copy_from_slice(&wide.to_be_bytes());
    }
    bytes.copy_within(1..60, 30);
    let words = bytes[3..].chunks_exact(4);
    words.fold(seed, |result, word| {
        let word = word.try_into().map_or(0, u32::from_le_bytes);
        mix(result, word)
    })
}
