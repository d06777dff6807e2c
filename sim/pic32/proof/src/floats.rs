//! Floating point by the compiler's own routines.

use crate::{Numbers, mix};

/// Square roots by Newton, sums of fractions, conversions, comparisons.
pub(crate) fn single(seed: u32) -> u32 {
    let mut numbers = Numbers::new(seed);
    let mut result = seed;
    for _ in 0..8 {
        let value = numbers.next() as f32 / 1024.0 + 0.25;
        let mut root = value * 0.5;
        for _ in 0..6 {
            root = (root + value / root) * 0.5;
        }
        let rounded = (root * 16.0) as i32;
        let order = u32::from(root < value) << 1 | u32::from(root * root >= value);
        result = mix(mix(result, root.to_bits()), rounded.cast_unsigned() ^ order);
    }
    result
}

/// A polynomial and its slope.
pub(crate) fn double(seed: u32) -> u32 {
    let mut numbers = Numbers::new(seed);
    let mut result = seed;
    for _ in 0..6 {
        let x = f64::from(numbers.next().cast_signed()) / 2_147_483_648.0;
        let mut term = x;
        let mut sum = x;
        for step in 1..6_i32 {
            term *= -x * x / f64::from(2 * step * (2 * step + 1));
            sum += term;
        }
        let bits = sum.to_bits();
        result = mix(mix(result, bits as u32), (bits >> 32) as u32);
        result = mix(
            result,
            (sum * 1e6) as i64 as u32 ^ u32::from(f64::from(sum as f32) == sum),
        );
    }
    result
}
