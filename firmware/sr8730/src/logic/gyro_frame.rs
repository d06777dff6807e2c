//! Frames of the gyro module.
//!
//! The real module's frames are not known. Frame 1 is the simulator's placeholder from `robots/samsung-sr8730/gyro.md`:
//! AA 55, heading in hundredths of a degree (i32), turn rate in tenths of a degree per second (i16), little endian, and
//! the sum of these six bytes.

use rvac_protocol::message::Gyro;
use rvac_units::{Angle, AngularSpeed};

const FRAME: usize = 9;
const SYNC: [u8; 2] = [0xAA, 0x55];
/// Microradians in a hundredth of a degree, in thousandths.
const NANORAD_PER_CENTIDEGREE: i64 = 174_533;
/// Microradians per second in a tenth of a degree per second.
const URAD_PER_DECIDEGREE: i64 = 1_745_329;

/// A frame without a decoder is not a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameKind {
    /// Frame 1 of gyro.md.
    Placeholder,
}

impl FrameKind {
    /// From the calibration value `gyro-frame`.
    #[must_use]
    pub const fn from_calibration(value: Option<i32>) -> Option<Self> {
        match value {
            Some(1) => Some(Self::Placeholder),
            _ => None,
        }
    }
}

/// Collects bytes until a frame is whole.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrameReader {
    bytes: [u8; FRAME],
    length: u8,
}

impl FrameReader {
    /// Takes a byte; returns the content of a frame that it completes. After a wrong sum the next start is searched one
    /// byte later.
    pub fn push(&mut self, byte: u8) -> Option<Gyro> {
        if let Some(place) = self.bytes.get_mut(usize::from(self.length)) {
            *place = byte;
            self.length += 1;
        }
        self.align();
        if usize::from(self.length) < FRAME {
            return None;
        }
        let [_, _, body @ .., sum] = self.bytes;
        if body.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte)) == sum {
            self.length = 0;
            return Some(decode(body));
        }
        self.drop_first();
        self.align();
        None
    }

    /// A framing error or a lost byte: drops the frame.
    pub const fn restart(&mut self) {
        self.length = 0;
    }

    /// Drops bytes until the rest could begin a frame.
    fn align(&mut self) {
        while self.length > 0 && !self.could_begin() {
            self.drop_first();
        }
    }

    fn could_begin(&self) -> bool {
        self.bytes
            .iter()
            .zip(SYNC)
            .take(usize::from(self.length))
            .all(|(byte, sync)| *byte == sync)
    }

    fn drop_first(&mut self) {
        self.bytes.rotate_left(1);
        self.length = self.length.saturating_sub(1);
    }
}

fn decode(body: [u8; 6]) -> Gyro {
    let [a, b, c, d, rate @ ..] = body;
    let heading = i64::from(i32::from_le_bytes([a, b, c, d]));
    let rate = i64::from(i16::from_le_bytes(rate));
    let saturate = |value: i64| i32::try_from(value).unwrap_or(if value < 0 { i32::MIN } else { i32::MAX });
    Gyro {
        heading: Angle(saturate(heading * NANORAD_PER_CENTIDEGREE / 1_000)),
        rate: AngularSpeed(saturate(rate * URAD_PER_DECIDEGREE / 1_000)),
    }
}

#[cfg(test)]
mod tests {
    use super::{FrameKind, FrameReader};
    use rvac_protocol::message::Gyro;
    use rvac_units::{Angle, AngularSpeed};
    use std::vec::Vec;

    fn frame(heading: i32, rate: i16) -> Vec<u8> {
        let body: Vec<u8> = heading
            .to_le_bytes()
            .into_iter()
            .chain(rate.to_le_bytes())
            .collect();
        let sum = body.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        [0xAA, 0x55].into_iter().chain(body).chain([sum]).collect()
    }

    fn read(reader: &mut FrameReader, bytes: &[u8]) -> Vec<Gyro> {
        bytes.iter().filter_map(|byte| reader.push(*byte)).collect()
    }

    #[test]
    fn a_quarter_turn_and_its_rate() {
        let found = read(&mut FrameReader::default(), &frame(9_000, -450));
        assert_eq!(
            found,
            [Gyro {
                heading: Angle(1_570_797),
                rate: AngularSpeed(-785_398)
            }]
        );
    }

    #[test]
    fn frames_are_found_after_rubbish_that_looks_like_a_start() {
        let mut bytes = std::vec![0x55, 0xAA, 0xAA, 0x55, 1, 2, 0xAA];
        bytes.extend(frame(100, 0));
        bytes.extend(frame(200, 0));
        let found = read(&mut FrameReader::default(), &bytes);
        assert_eq!(found.len(), 2);
    }

    #[test]
    fn a_wrong_sum_costs_one_frame() {
        let mut bytes = frame(100, 0);
        *bytes.last_mut().unwrap() ^= 1;
        bytes.extend(frame(-200, 0));
        let found = read(&mut FrameReader::default(), &bytes);
        assert_eq!(
            found,
            [Gyro {
                heading: Angle(-34_906),
                rate: AngularSpeed(0)
            }]
        );
    }

    #[test]
    fn a_frame_that_holds_its_own_start_bytes_is_read_whole() {
        let heading = i32::from_le_bytes([0xAA, 0x55, 0xAA, 0x55]);
        let bytes = [frame(heading, 0x55AA), frame(1, 1)].concat();
        assert_eq!(read(&mut FrameReader::default(), &bytes).len(), 2);
    }

    #[test]
    fn only_frames_with_a_decoder_are_kinds() {
        assert_eq!(FrameKind::from_calibration(Some(1)), Some(FrameKind::Placeholder));
        assert_eq!(FrameKind::from_calibration(Some(2)), None);
        assert_eq!(FrameKind::from_calibration(None), None);
    }
}
