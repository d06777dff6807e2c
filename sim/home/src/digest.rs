//! A running hash of a simulation, to check whether two runs were the same.

/// FNV-1a over bytes, 64 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fnv1a(u64);

impl Default for Fnv1a {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv1a {
    /// Takes a byte.
    pub const fn byte(&mut self, byte: u8) {
        self.0 = (self.0 ^ byte as u64).wrapping_mul(0x0100_0000_01b3);
    }

    /// Takes a word.
    pub fn word(&mut self, word: u64) {
        for byte in word.to_le_bytes() {
            self.byte(byte);
        }
    }

    /// The hash of all bytes taken.
    #[must_use]
    pub const fn value(self) -> u64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::Fnv1a;

    #[test]
    fn order_matters() {
        let of = |bytes: &[u8]| {
            let mut digest = Fnv1a::default();
            bytes.iter().for_each(|byte| digest.byte(*byte));
            digest.value()
        };
        assert_eq!(of(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_ne!(of(b"ab"), of(b"ba"));
    }
}
