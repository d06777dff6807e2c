//! Work that ends in a number: checksums, sorting, 64-bit and floating point arithmetic, text, a tree walk.
//!
//! The same functions run in the emulator and under qemu-user; the results must be equal. Nothing depends on addresses.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod arithmetic;
mod bytes;
mod floats;
mod machine;

/// A piece of work: from a seed to a number that depends on every step.
pub type Work = fn(u32) -> u32;

/// All of them.
pub const WORKS: [Work; 10] = [
    bytes::checksum,
    bytes::sort,
    bytes::hash,
    bytes::text,
    bytes::unaligned,
    arithmetic::wide,
    arithmetic::matrix,
    floats::single,
    floats::double,
    machine::interpret,
];

/// One round: each piece of work once.
pub fn round(number: u32, results: &mut [u32; WORKS.len()]) {
    for (place, work) in results.iter_mut().zip(WORKS) {
        *place = work(core::hint::black_box(number));
    }
}

/// A generator for contents that nothing depends on (xorshift).
struct Numbers(u32);

impl Numbers {
    fn new(seed: u32) -> Self {
        Self(seed.wrapping_mul(2_654_435_761) | 1)
    }

    fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }
}

/// Joins a number to a result.
fn mix(result: u32, number: u32) -> u32 {
    (result.rotate_left(5) ^ number).wrapping_mul(0x9E37_79B1)
}
