//! Bytes on a link that only the host clocks (SPI): those that say nothing lie between those that do.
//!
//! A slave has to answer each byte of the master at once, and a bus without a slave reads as all zeros or all ones. Both therefore are
//! *fill* here and mean nothing; where data have such a byte, [`ESCAPE`] and the byte with every second bit flipped stand for it.

/// What a side sends when it has nothing to say.
pub const FILL: u8 = 0x00;
/// What a bus without a slave may read as instead.
const FLOATING: u8 = 0xFF;
/// The next byte stands for another.
pub const ESCAPE: u8 = 0x1B;
/// Bits that an escaped byte has flipped: neither 0x00 nor 0xFF nor the escape itself becomes one of them.
const FLIPPED: u8 = 0x55;

/// One or two bytes that stand for this one on the line.
pub const fn encode(byte: u8) -> Encoded {
    match byte {
        FILL | FLOATING | ESCAPE => Encoded {
            bytes: [ESCAPE, byte ^ FLIPPED],
            next: 0,
        },
        _ => Encoded {
            bytes: [ESCAPE, byte],
            next: 1,
        },
    }
}

/// The bytes of [`encode`], in order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Encoded {
    bytes: [u8; 2],
    next: u8,
}

impl Iterator for Encoded {
    type Item = u8;

    fn next(&mut self) -> Option<u8> {
        let byte = self.bytes.get(usize::from(self.next)).copied()?;
        self.next += 1;
        Some(byte)
    }
}

/// Takes fill out of what a side receives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FillDecoder {
    is_escaped: bool,
}

impl FillDecoder {
    /// The byte of data that this one ends, if it ends one. Fill between an escape and its byte does no harm.
    pub const fn push(&mut self, byte: u8) -> Option<u8> {
        match byte {
            FILL | FLOATING => None,
            ESCAPE => {
                self.is_escaped = true;
                None
            }
            _ if self.is_escaped => {
                self.is_escaped = false;
                Some(byte ^ FLIPPED)
            }
            _ => Some(byte),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ESCAPE, FILL, FLOATING, FillDecoder, encode};

    #[test]
    fn every_byte_comes_back_and_none_is_fill_on_the_line() {
        for byte in 0..=u8::MAX {
            let mut decoder = FillDecoder::default();
            let mut data = None;
            for on_line in encode(byte) {
                assert!(on_line != FILL && on_line != FLOATING, "{byte}");
                assert_eq!(data, None);
                assert_eq!(decoder.push(FILL), None);
                assert_eq!(decoder.push(FLOATING), None);
                data = decoder.push(on_line);
            }
            assert_eq!(data, Some(byte));
        }
        assert_eq!(encode(b'{').count(), 1);
        assert!(encode(ESCAPE).eq([0x1B, 0x4E]));
        assert!(encode(0x00).eq([0x1B, 0x55]));
        assert!(encode(0xFF).eq([0x1B, 0xAA]));
    }
}
