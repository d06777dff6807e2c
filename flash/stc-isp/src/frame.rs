//! Frames of the line: to the chip `46 B9 6A LH LL payload SUM 16`, from the chip the same with 68 in place of 6A.
//!
//! The length counts from 6A or 68 to 16. The chip's first frame, its status, begins with 68 on this family; so a frame is taken from
//! there on, and what stands before it is dropped.

const FROM_CHIP: u8 = 0x68;
const TO_CHIP: u8 = 0x6A;
const END: u8 = 0x16;
/// Longest length that a frame of the chip has; the status has about 60.
const LENGTH_MAX: usize = 300;
/// Direction, length, sum and end.
const OVERHEAD: usize = 5;

/// The frame with this payload.
pub(crate) fn to_chip(payload: &[u8]) -> Vec<u8> {
    let length = (payload.len() + OVERHEAD) as u16;
    let mut frame = vec![0x46, 0xB9, TO_CHIP];
    frame.extend(length.to_be_bytes());
    frame.extend(payload);
    frame.push(sum(&frame[2..]));
    frame.push(END);
    frame
}

/// Low byte of the sum.
pub(crate) fn sum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum: u8, byte| sum.wrapping_add(*byte))
}

/// What arrived and is no whole frame yet.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrameBuffer {
    bytes: Vec<u8>,
}

impl FrameBuffer {
    pub(crate) fn push(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    pub(crate) fn clear(&mut self) {
        self.bytes.clear();
    }

    /// The payload of the first whole frame; what is before it is dropped.
    pub(crate) fn take(&mut self) -> Option<Vec<u8>> {
        for start in 0..self.bytes.len() {
            if let Some((payload, end)) = whole_frame(self.bytes.get(start..)?) {
                self.bytes.drain(..start + end);
                return Some(payload);
            }
        }
        // No frame can begin in what is older than the longest one.
        let spare = self.bytes.len().saturating_sub(LENGTH_MAX);
        self.bytes.drain(..spare);
        None
    }
}

/// The payload of the frame at the start of `bytes`, and where it ends.
fn whole_frame(bytes: &[u8]) -> Option<(Vec<u8>, usize)> {
    let [FROM_CHIP, high, low, ..] = bytes else {
        return None;
    };
    let length = usize::from(u16::from_be_bytes([*high, *low]));
    if !(OVERHEAD + 1..=LENGTH_MAX).contains(&length) {
        return None;
    }
    let frame = bytes.get(..length)?;
    let [covered @ .., told, END] = frame else {
        return None;
    };
    let is_right = sum(covered) == *told;
    is_right.then(|| (covered.get(3..).unwrap_or_default().to_vec(), length))
}

#[cfg(test)]
mod tests {
    use super::{FrameBuffer, to_chip};

    #[test]
    fn the_reference_s_frames() {
        assert_eq!(to_chip(&[0x82]), [0x46, 0xB9, 0x6A, 0x00, 0x06, 0x82, 0xF2, 0x16]);
        let mut buffer = FrameBuffer::default();
        buffer.push(&[0x46, 0xB9, 0x68, 0x00, 0x06, 0x80, 0xEE]);
        assert_eq!(buffer.take(), None);
        buffer.push(&[0x16]);
        assert_eq!(buffer.take(), Some(vec![0x80]));
        assert_eq!(buffer.take(), None);
    }

    #[test]
    fn garbage_before_a_frame_is_dropped_and_a_wrong_sum_is_no_frame() {
        let mut buffer = FrameBuffer::default();
        buffer.push(&[0x68, 0x00, 0x09, 0xFF, 0x68, 0x00, 0x06, 0x80, 0xEE, 0x16]);
        assert_eq!(buffer.take(), Some(vec![0x80]));
        buffer.push(&[0x68, 0x00, 0x06, 0x81, 0xEE, 0x16]);
        assert_eq!(buffer.take(), None);
        for _ in 0..100 {
            buffer.push(&[0x68; 100]);
            assert_eq!(buffer.take(), None);
        }
        assert!(buffer.bytes.len() <= super::LENGTH_MAX);
    }
}
