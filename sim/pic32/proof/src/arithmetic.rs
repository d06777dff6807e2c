//! Work on integers.

use crate::{Numbers, mix};

/// Multiplications, divisions and shifts of 64 bits, signed and not, with and without overflow.
pub(crate) fn wide(seed: u32) -> u32 {
    let mut numbers = Numbers::new(seed);
    let mut result = seed;
    for _ in 0..40 {
        let left = u64::from(numbers.next()) << 32 | u64::from(numbers.next());
        let right = u64::from(numbers.next()) >> (numbers.next() & 31) | 1;
        let signed = left.cast_signed() / right.cast_signed().wrapping_neg();
        let rest = left.cast_signed() % 1_000_003;
        let product = left.checked_mul(right).unwrap_or(left ^ right);
        let shifted = left >> (right & 63) ^ left << (right >> 7 & 63);
        let quotient = left / right;
        let count = left.leading_zeros() + right.trailing_zeros() + (left ^ right).count_ones();
        for value in [
            signed.cast_unsigned(),
            rest.cast_unsigned(),
            product,
            shifted,
            quotient,
        ] {
            result = mix(mix(result, value as u32), (value >> 32) as u32);
        }
        let narrow = numbers.next().cast_signed();
        let divisor = (numbers.next() >> 20).cast_signed() - 2048;
        let divided = narrow.checked_div(divisor).unwrap_or(7) ^ narrow.checked_rem(divisor).unwrap_or(9);
        result = mix(result, divided.cast_unsigned() ^ count);
    }
    result
}

/// Fixed-point matrices, as controllers have them.
pub(crate) fn matrix(seed: u32) -> u32 {
    let mut numbers = Numbers::new(seed);
    let mut left = [[0_i32; 6]; 6];
    let mut right = [[0_i32; 6]; 6];
    for (row, other) in left.iter_mut().zip(&mut right) {
        row.fill_with(|| (numbers.next() >> 12).cast_signed() - (1 << 19));
        other.fill_with(|| (numbers.next() >> 12).cast_signed() - (1 << 19));
    }
    for _ in 0..4 {
        let mut product = [[0_i32; 6]; 6];
        for (row, results) in left.iter().zip(&mut product) {
            for (column, result) in results.iter_mut().enumerate() {
                let sum: i64 = row
                    .iter()
                    .zip(&right)
                    .map(|(factor, other)| i64::from(*factor) * i64::from(other[column]))
                    .sum();
                *result = (sum >> 16).clamp(-0x4000_0000, 0x4000_0000) as i32;
            }
        }
        left = product;
    }
    left.iter()
        .flatten()
        .fold(seed, |result, value| mix(result, value.cast_unsigned()))
}
