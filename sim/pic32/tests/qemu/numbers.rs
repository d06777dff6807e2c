//! Numbers from a seed (splitmix64).

/// A generator.
#[derive(Clone, Debug)]
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5851_F42D_4C95_7F2D)
    }

    pub(crate) fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut value = self.0;
        value = (value ^ value >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        value = (value ^ value >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        (value >> 32) as u32
    }

    /// 0..limit.
    pub(crate) fn below(&mut self, limit: u32) -> u32 {
        ((u64::from(self.next()) * u64::from(limit)) >> 32) as u32
    }

    pub(crate) fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len() as u32) as usize]
    }

    /// Numbers at which arithmetic goes wrong, and others.
    pub(crate) fn interesting(&mut self) -> u32 {
        match self.below(3) {
            0 => self.pick(&[
                0,
                1,
                2,
                3,
                4,
                7,
                8,
                31,
                32,
                0x7F,
                0x80,
                0xFF,
                0x100,
                0x7FFF,
                0x8000,
                0xFFFF,
                0x1_0000,
                0x7FFF_FFFF,
                0x8000_0000,
                0x8000_0001,
                0xFFFF_8000,
                0xFFFF_7FFF,
                0xFFFF_FF80,
                0xFFFF_FFFE,
                u32::MAX,
            ]),
            1 => self.next() >> self.below(32),
            _ => self.next(),
        }
    }
}
