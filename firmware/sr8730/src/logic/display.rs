//! Four digits of seven segments, for sisters of the robot that have such a display.
//!
//! Digits and lights share lines, so they take turns: a group of lights, a digit, the other group, the next digit, a millisecond
//! each. A lit digit is on for an eighth of the time, a light for a quarter instead of half. While all digits are dark the lights
//! have the whole time.

use rvac_units::Ratio;

use super::lamps::{LampLines, Lamps};

/// Digits of the display.
pub const DIGITS: usize = 4;
/// Segments of a digit: bit 0 is a (top), b to f follow clockwise, bit 6 is g (middle).
pub const SEGMENTS: usize = 7;
/// With a digit's turn between two of the lights, the darkest of eight levels would flash 31 times a second, which the eye
/// sees. Four levels flash 62 times.
const LIGHT_STEP: i32 = 250_000;

/// What a person at the robot is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayContent {
    /// How full the battery is.
    Charge(Ratio),
    /// Nobody knows how full the battery is: it has not been measured yet.
    UnknownCharge,
    /// A fault is latched: the panel says which.
    Fault,
}

/// Segments of the figures 0 to 9.
const FIGURES: [u8; 10] = [0x3F, 0x06, 0x5B, 0x4F, 0x66, 0x6D, 0x7D, 0x07, 0x7F, 0x6F];
const DASH: u8 = 0x40;
const LETTER_E: u8 = 0x79;
const LETTER_R: u8 = 0x50;

impl DisplayContent {
    /// The segments of all digits, from the left.
    #[must_use]
    pub fn segments(self) -> [u8; DIGITS] {
        match self {
            Self::UnknownCharge => [0, 0, DASH, DASH],
            Self::Fault => [0, LETTER_E, LETTER_R, LETTER_R],
            Self::Charge(charge) => percent(charge),
        }
    }
}

/// A charge in percent, without leading zeros.
fn percent(charge: Ratio) -> [u8; DIGITS] {
    let mut left = charge
        .millionths()
        .clamp(0, 1_000_000)
        .unsigned_abs()
        .saturating_add(5_000)
        / 10_000;
    let mut shown = [0; DIGITS];
    for segments in shown.iter_mut().rev() {
        *segments = FIGURES.get((left % 10) as usize).copied().unwrap_or_default();
        left /= 10;
        if left == 0 {
            break;
        }
    }
    shown
}

/// Who has the shared lines for a millisecond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// A group of lights.
    Lamps(LampLines),
    /// A digit, with the segments that are lit.
    Digit {
        /// 0 is the left one.
        digit: usize,
        /// Bit by segment.
        segments: u8,
    },
}

/// Lights and digits, and the place in their round.
#[derive(Clone, Copy, Debug, Default)]
pub struct PanelRound {
    lamps: Lamps,
    digits: [u8; DIGITS],
    next_digit: usize,
    is_digits_turn: bool,
}

impl PanelRound {
    /// Sets one light, in coarser levels where the robot has a display.
    pub fn set(&mut self, light: u8, brightness: Ratio, has_display: bool) {
        let millionths = brightness.millionths();
        let coarse = millionths.saturating_add(LIGHT_STEP - 1) / LIGHT_STEP * LIGHT_STEP;
        let coarse = Ratio::from_millionths(coarse).unwrap_or(brightness);
        self.lamps
            .set(light, if has_display { coarse } else { brightness });
    }

    /// Shows these segments.
    pub const fn write(&mut self, digits: [u8; DIGITS]) {
        self.digits = digits;
    }

    fn has_lit_digits(&self) -> bool {
        self.digits.iter().any(|segments| *segments != 0)
    }

    /// Whether anything is lit: if not, the lines can stay as they are, off.
    #[must_use]
    pub fn any(&self) -> bool {
        self.lamps.any() || self.has_lit_digits()
    }

    /// The next millisecond.
    pub fn change(&mut self) -> Turn {
        self.is_digits_turn = !self.is_digits_turn && self.has_lit_digits();
        if !self.is_digits_turn {
            return Turn::Lamps(self.lamps.change());
        }
        let digit = self.next_digit;
        self.next_digit = (digit + 1) % DIGITS;
        Turn::Digit {
            digit,
            segments: self.digits.get(digit).copied().unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DIGITS, DisplayContent, PanelRound, SEGMENTS, Turn};
    use crate::logic::lamps::Group;
    use rvac_units::Ratio;
    use std::string::String;
    use std::vec::Vec;

    fn ratio(millionths: i32) -> Ratio {
        Ratio::from_millionths(millionths).unwrap()
    }

    /// The segments as a person sees them, on three lines.
    fn picture(digits: [u8; DIGITS]) -> [String; 3] {
        let cell =
            |segments: u8, segment: u8, mark: char| if segments >> segment & 1 == 1 { mark } else { ' ' };
        let row = |cells: [(Option<u8>, char); 3]| {
            let of_digit = |segments: &u8| -> Vec<char> {
                cells
                    .iter()
                    .map(|(segment, mark)| segment.map_or(' ', |segment| cell(*segments, segment, *mark)))
                    .collect()
            };
            digits.iter().flat_map(of_digit).collect::<String>()
        };
        [
            row([(None, ' '), (Some(0), '_'), (None, ' ')]),
            row([(Some(5), '|'), (Some(6), '_'), (Some(1), '|')]),
            row([(Some(4), '|'), (Some(3), '_'), (Some(2), '|')]),
        ]
    }

    #[test]
    fn a_person_reads_the_charge() {
        for (millionths, rows) in [
            (1_000_000, ["       _  _ ", "     || || |", "     ||_||_|"]),
            (876_000, ["       _  _ ", "      |_||_|", "      |_||_|"]),
            (974_999, ["       _  _ ", "      |_|  |", "       _|  |"]),
            (421_000, ["          _ ", "      |_| _|", "        ||_ "]),
            (63_000, ["          _ ", "         |_ ", "         |_|"]),
            (0, ["          _ ", "         | |", "         |_|"]),
        ] {
            let shown = picture(DisplayContent::Charge(ratio(millionths)).segments());
            assert_eq!(shown, rows, "{millionths}");
        }
    }

    #[test]
    fn a_person_reads_that_something_is_wrong_or_not_known() {
        assert_eq!(
            picture(DisplayContent::Fault.segments()),
            ["    _       ", "   |_  _  _ ", "   |_ |  |  "]
        );
        assert_eq!(
            picture(DisplayContent::UnknownCharge.segments()),
            ["            ", "       _  _ ", "            "]
        );
    }

    /// Milliseconds of 160 in which each segment and each line of the lights is on.
    fn shares(round: &mut PanelRound) -> ([[u32; SEGMENTS]; DIGITS], [[u32; 5]; 2]) {
        let (mut digits, mut lamps) = ([[0; SEGMENTS]; DIGITS], [[0; 5]; 2]);
        for _ in 0..160 {
            match round.change() {
                Turn::Digit { digit, segments } => {
                    for (segment, count) in digits[digit].iter_mut().enumerate() {
                        *count += u32::from(segments >> segment & 1);
                    }
                }
                Turn::Lamps(shown) => {
                    for (line, count) in lamps[usize::from(shown.group == Group::Battery)]
                        .iter_mut()
                        .enumerate()
                    {
                        *count += u32::from(shown.lines >> line & 1);
                    }
                }
            }
        }
        (digits, lamps)
    }

    #[test]
    fn digits_and_lights_share_the_time() {
        let mut round = PanelRound::default();
        round.set(6, Ratio::ONE, true);
        round.write([0, 0, 0b000_0001, 0b100_0000]);
        let (digits, lamps) = shares(&mut round);
        assert_eq!((digits[2][0], digits[3][6]), (20, 20));
        assert_eq!(digits.iter().flatten().sum::<u32>(), 40, "nothing else is lit");
        assert_eq!(lamps, [[0; 5], [0, 0, 0, 40, 0]]);
    }

    #[test]
    fn dark_digits_take_no_time() {
        let mut round = PanelRound::default();
        assert!(!round.any());
        round.set(0, Ratio::ONE, true);
        assert!(round.any());
        assert_eq!(shares(&mut round).1[0][0], 80);
        round.set(0, Ratio::ZERO, true);
        round.write([0, 0, 0, 1]);
        assert!(round.any(), "a digit alone is shown");
    }

    #[test]
    fn the_darkest_light_beside_digits_flashes_without_long_gaps() {
        let mut round = PanelRound::default();
        round.set(2, ratio(1), true);
        round.write([0x7F; DIGITS]);
        let mut gap = 0;
        for _ in 0..400 {
            let lit = matches!(round.change(), Turn::Lamps(shown) if shown.lines != 0);
            gap = if lit { 0 } else { gap + 1 };
            assert!(gap < 16);
        }
    }
}
