//! Frames of the loader's line, from the chip's side.

const LENGTH_MAX: usize = 300;

/// The frame with this payload, from the chip.
pub(super) fn from_chip(payload: &[u8]) -> Vec<u8> {
    let mut frame = vec![0x46, 0xB9, 0x68];
    frame.extend((payload.len() as u16 + 5).to_be_bytes());
    frame.extend(payload);
    let sum = frame[2..].iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
    frame.extend([sum, 0x16]);
    frame
}

/// What came of a frame up to now.
#[derive(Clone, Debug, Default)]
pub(super) struct Incoming {
    bytes: Vec<u8>,
}

impl Incoming {
    /// Takes a byte; gives the payload of the frame that it ends.
    pub(super) fn push(&mut self, byte: u8) -> Option<Vec<u8>> {
        self.bytes.push(byte);
        while !self.may_begin() {
            self.bytes.remove(0);
        }
        let [_, _, _, high, low, ..] = self.bytes.as_slice() else {
            return None;
        };
        let length = usize::from(u16::from_be_bytes([*high, *low]));
        if !(6..=LENGTH_MAX).contains(&length) {
            self.bytes.remove(0);
            return None;
        }
        if self.bytes.len() < length + 2 {
            return None;
        }
        let frame = std::mem::take(&mut self.bytes);
        let [_, _, covered @ .., sum, 0x16] = frame.as_slice() else {
            return None;
        };
        let is_right = covered.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte)) == *sum;
        // A wrong sum is answered with silence.
        is_right.then(|| covered[3..].to_vec())
    }

    fn may_begin(&self) -> bool {
        let start = [0x46, 0xB9, 0x6A];
        self.bytes.iter().zip(start).all(|(byte, wanted)| *byte == wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::Incoming;

    #[test]
    fn a_frame_is_taken_whole_and_only_with_its_sum() {
        let mut incoming = Incoming::default();
        let mut all = |bytes: &[u8]| {
            let found: Vec<Vec<u8>> = bytes.iter().filter_map(|byte| incoming.push(*byte)).collect();
            found
        };
        assert_eq!(
            all(&[0x46, 0xB9, 0x6A, 0x00, 0x06, 0x82, 0xF2, 0x16]),
            [vec![0x82]]
        );
        assert_eq!(
            all(&[0x46, 0x46, 0xB9, 0x6A, 0x00, 0x06, 0x82, 0xF2, 0x16]),
            [vec![0x82]]
        );
        assert!(all(&[0x46, 0xB9, 0x6A, 0x00, 0x06, 0x82, 0xF3, 0x16]).is_empty());
        assert_eq!(
            all(&[0x7F, 0x46, 0xB9, 0x6A, 0x00, 0x06, 0x82, 0xF2, 0x16]),
            [vec![0x82]]
        );
    }
}
