//! A word on its way through the shift register of an SPI, both directions at once, highest bit first.

/// The word that is sent and the one that comes in for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SpiWord {
    out: u32,
    bits: u8,
    shifted: u8,
    taken: u32,
    sampled: u8,
}

impl SpiWord {
    pub(super) fn new(out: u32, bits: u8) -> SpiWord {
        SpiWord {
            out,
            bits,
            shifted: 0,
            taken: 0,
            sampled: 0,
        }
    }

    /// The next bit to send; nothing after the last.
    pub(super) fn shift(&mut self) -> Option<bool> {
        let left = self.bits.checked_sub(self.shifted + 1)?;
        self.shifted += 1;
        Some(self.out >> left & 1 != 0)
    }

    /// Takes a bit; the word when it was the last.
    pub(super) fn sample(&mut self, input: bool) -> Option<u32> {
        self.taken = self.taken << 1 | u32::from(input);
        self.sampled += 1;
        (self.sampled == self.bits).then_some(self.taken)
    }

    /// Whether the other side has clocked any of it.
    pub(super) fn has_begun(&self) -> bool {
        self.sampled > 0
    }
}
