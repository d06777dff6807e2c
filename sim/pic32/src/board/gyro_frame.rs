//! Frames of a gyro module: the placeholder of `robots/samsung-sr8730/gyro.md`, or an unknown layout generated from a
//! number, so that identifying an unknown module can be tested.

use home::Pcg;

/// Which gyro module the robot has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GyroFitted {
    /// None, or one whose plug is out.
    Absent,
    /// One that sends frame 1 of `gyro.md`, on the UART and at the rate of the calibration table.
    #[default]
    Placeholder,
    /// One whose port, rate and frames this number makes up.
    Unknown(u64),
}

/// A made-up module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroLayout {
    /// UART of the chip, 1 or 2.
    pub uart: u8,
    /// Bits per second.
    pub baud: u32,
    /// Milliseconds from frame to frame.
    pub period_ms: u64,
    /// First bytes of each frame.
    pub head: [u8; 2],
    /// Bytes between head and number: a counter of frames, then a status that never changes; 0 to 2.
    pub filler_bytes: u8,
    /// The number is the heading, else the turn rate.
    pub tells_heading: bool,
    /// It has four bytes, else two.
    pub wide: bool,
    /// Its highest byte comes first.
    pub big_endian: bool,
    /// Steps of the number for a degree or a degree a second, counter-clockwise positive.
    pub steps_per_degree: f64,
    /// The last byte of the frame, if it is a check value.
    pub check: GyroCheck,
}

/// A check value in the last byte, over all bytes before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GyroCheck {
    /// There is none.
    None,
    /// Sum modulo 256.
    Sum,
    /// What makes the sum zero.
    NegatedSum,
    /// Exclusive or.
    Xor,
}

const STREAM: u64 = 0x6796;
const STATUS: u8 = 0x03;

impl GyroLayout {
    /// The module of this number.
    #[must_use]
    pub fn unknown(seed: u64) -> Self {
        let mut random = Pcg::new(seed, STREAM);
        let mut pick = |count: u32| random.below(count) as usize;
        let baud = [9_600, 19_200, 38_400, 57_600, 115_200][pick(5)];
        let (tells_heading, wide) = (pick(2) == 0, pick(2) == 0);
        // What two bytes hold without a wrap in a turn or two.
        let steps = match (tells_heading, wide) {
            (true, true) => [100.0, 1_000.0][pick(2)],
            (true, false) => [10.0, 40.0][pick(2)],
            (false, _) => [10.0, 16.4, 32.8, 131.0][pick(4)],
        };
        Self {
            uart: [1, 2][pick(2)],
            baud,
            period_ms: if baud < 38_400 { 20 } else { 10 },
            head: [[0xA5, 0x5A], [0x7E, 0x12], [0x55, 0x53], [0xB5, 0x62]][pick(4)],
            filler_bytes: [0, 1, 2][pick(3)],
            tells_heading,
            wide,
            big_endian: pick(2) == 0,
            steps_per_degree: [steps, -steps][pick(2)],
            check: [
                GyroCheck::None,
                GyroCheck::Sum,
                GyroCheck::NegatedSum,
                GyroCheck::Xor,
            ][pick(4)],
        }
    }

    /// Place of the number in the frame.
    #[must_use]
    pub fn number_at(&self) -> usize {
        self.head.len() + usize::from(self.filler_bytes)
    }

    /// Bytes of a frame.
    #[must_use]
    pub fn frame_bytes(&self) -> usize {
        self.number_at() + if self.wide { 4 } else { 2 } + usize::from(self.check != GyroCheck::None)
    }

    /// The frame of this heading, degrees, and turn rate, degrees a second, counter-clockwise.
    pub(super) fn frame(&self, (heading, rate): (f64, f64), count: u8) -> Vec<u8> {
        let sent = if self.tells_heading { heading } else { rate };
        let number = (sent * self.steps_per_degree).round() as i32;
        let mut frame = self.head.to_vec();
        frame.extend([count, STATUS].iter().take(usize::from(self.filler_bytes)));
        // Two bytes hold the lower half: a number that outgrows them wraps.
        let narrow = number as i16;
        match (self.wide, self.big_endian) {
            (true, true) => frame.extend(number.to_be_bytes()),
            (true, false) => frame.extend(number.to_le_bytes()),
            (false, true) => frame.extend(narrow.to_be_bytes()),
            (false, false) => frame.extend(narrow.to_le_bytes()),
        }
        frame.extend(self.check.of(&frame));
        frame
    }
}

impl GyroCheck {
    fn of(self, bytes: &[u8]) -> Option<u8> {
        let sum = bytes.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        match self {
            Self::None => None,
            Self::Sum => Some(sum),
            Self::NegatedSum => Some(sum.wrapping_neg()),
            Self::Xor => Some(bytes.iter().fold(0, |xor, byte| xor ^ byte)),
        }
    }
}

/// Frame 1 of `gyro.md`.
pub(super) fn placeholder((heading, rate): (f64, f64)) -> Vec<u8> {
    const SYNC: [u8; 2] = [0xAA, 0x55];
    // Hundredths and tenths of a degree.
    let mut body = ((heading * 100.0).round() as i32).to_le_bytes().to_vec();
    body.extend(((rate * 10.0).round() as i16).to_le_bytes());
    let check = GyroCheck::Sum.of(&body);
    SYNC.into_iter().chain(body).chain(check).collect()
}

#[cfg(test)]
mod tests {
    use super::{GyroCheck, GyroLayout, placeholder};

    #[test]
    fn frames_hold_what_the_layout_says() {
        let layout = GyroLayout {
            uart: 2,
            baud: 9_600,
            period_ms: 20,
            head: [0x7E, 0x12],
            filler_bytes: 1,
            tells_heading: false,
            wide: false,
            big_endian: true,
            steps_per_degree: -10.0,
            check: GyroCheck::Xor,
        };
        assert_eq!(
            layout.frame((90.0, 51.3), 7),
            [0x7E, 0x12, 7, 0xFD, 0xFF, 0x7E ^ 0x12 ^ 7 ^ 0xFD ^ 0xFF]
        );
        assert_eq!((layout.number_at(), layout.frame_bytes()), (3, 6));
        assert_eq!(
            placeholder((90.0, -0.1)),
            [0xAA, 0x55, 0x28, 0x23, 0, 0, 0xFF, 0xFF, 0x49]
        );
    }

    #[test]
    fn numbers_make_modules_that_fit_their_lines_and_differ() {
        let modules: Vec<GyroLayout> = (0..64).map(GyroLayout::unknown).collect();
        for module in &modules {
            let bytes_a_second = module.frame_bytes() as u64 * 1_000 / module.period_ms;
            assert!(bytes_a_second * 10 < u64::from(module.baud), "{module:?}");
        }
        for uart in [1, 2] {
            assert!(modules.iter().any(|module| module.uart == uart));
        }
        assert!(modules.iter().any(|module| module.tells_heading && module.wide));
        assert!(modules.iter().any(|module| module.check == GyroCheck::None));
    }
}
