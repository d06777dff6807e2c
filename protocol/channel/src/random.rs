//! A small seeded generator: PCG-XSH-RR with 64 bits of state (O'Neill 2014).

/// Pseudo-random numbers that are the same for the same seed on every machine.
#[derive(Clone, Debug)]
pub struct Pcg32 {
    state: u64,
}

const MULTIPLIER: u64 = 6_364_136_223_846_793_005;
const INCREMENT: u64 = 1_442_695_040_888_963_407;

impl Pcg32 {
    /// A generator for `seed`.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut random = Self {
            state: seed.wrapping_add(INCREMENT),
        };
        random.next_u32();
        random
    }

    /// The next 32 bits.
    #[inline]
    pub fn next_u32(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(MULTIPLIER).wrapping_add(INCREMENT);
        let mixed = (((old >> 18) ^ old) >> 27) as u32;
        mixed.rotate_right((old >> 59) as u32)
    }

    /// A whole number from 0 to `end - 1`; 0 for `end` 0. The bias of at most `end` / 2^32 does not matter for faults.
    #[inline]
    pub fn below(&mut self, end: u32) -> u32 {
        ((u64::from(self.next_u32()) * u64::from(end)) >> 32) as u32
    }

    /// A number from 0 up to but without 1.
    #[inline]
    pub fn unit(&mut self) -> f64 {
        f64::from(self.next_u32()) / 4_294_967_296.0
    }

    /// Whether something of this probability happens.
    #[inline]
    pub fn happens(&mut self, probability: f64) -> bool {
        probability > 0.0 && self.unit() < probability
    }

    /// How many misses come before the next hit of this probability; never, if it is 0.
    pub fn misses_before_hit(&mut self, probability: f64) -> u64 {
        if probability <= 0.0 {
            return u64::MAX;
        }
        // 1 - unit() lies in (0, 1], so the logarithm is finite.
        ((1.0 - self.unit()).ln() / (1.0 - probability).ln()) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::Pcg32;

    #[test]
    fn same_seed_same_numbers() {
        let numbers = |seed| {
            let mut random = Pcg32::new(seed);
            [random.next_u32(), random.next_u32(), random.next_u32()]
        };
        assert_eq!(numbers(7), numbers(7));
        assert_ne!(numbers(7), numbers(8));
    }

    #[test]
    fn gaps_have_the_mean_of_their_probability() {
        let mut random = Pcg32::new(1);
        let total: u64 = (0..100_000).map(|_| random.misses_before_hit(0.01)).sum();
        let mean = total as f64 / 100_000.0;
        assert!((98.0..100.0).contains(&mean), "mean gap {mean}, expected 99");
        assert_eq!(random.misses_before_hit(0.0), u64::MAX);
    }
}
