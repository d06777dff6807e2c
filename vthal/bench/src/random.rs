//! Randomness for moments and numbers of changes, the same for the same seed.

/// Marsaglia's xorshift with 64 bits: neither moments nor choices of a trial need better. `state` must not be 0.
pub fn next_random(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}
