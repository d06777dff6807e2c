//! Which of the three buttons is down.
//!
//! One line (INT2) says that a button is pressed, a resistor ladder on AN0 which. The levels of the ladder are calibration
//! values; without them every press counts as all three buttons, because which one it is nobody can say, and every button
//! stops the robot.

/// Buttons of this robot.
pub const BUTTONS: u8 = 3;
/// All of them, bit by number.
pub const ALL: u8 = (1 << BUTTONS) - 1;
/// A reading this far or further from every known level is none of them.
const TOLERANCE_COUNTS: u16 = 60;

/// Readings for each button pressed alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ladder {
    levels: [u16; BUTTONS as usize],
}

impl Ladder {
    /// From the calibration; `None` unless all are known.
    #[must_use]
    pub fn new(levels: [Option<i32>; BUTTONS as usize]) -> Option<Self> {
        let [first, second, third] = levels.map(|level| u16::try_from(level?).ok());
        Some(Self {
            levels: [first?, second?, third?],
        })
    }

    /// The button whose level is nearest, bit by number; all of them if none is near: several are held, or the wire is bad,
    /// and a press must not be lost.
    #[must_use]
    pub fn pressed(&self, reading: u16) -> u8 {
        let mut nearest = (TOLERANCE_COUNTS, ALL);
        for (number, level) in self.levels.iter().enumerate() {
            let distance = level.abs_diff(reading);
            if distance < nearest.0 {
                nearest = (distance, 1 << number);
            }
        }
        nearest.1
    }
}

/// Buttons that are down, bit by number, from the press line and the ladder.
#[must_use]
pub fn down(any_pressed: bool, ladder: Option<&Ladder>, reading: u16) -> u8 {
    match (any_pressed, ladder) {
        (false, _) => 0,
        (true, Some(ladder)) => ladder.pressed(reading),
        (true, None) => ALL,
    }
}

#[cfg(test)]
mod tests {
    use super::{ALL, Ladder, down};

    #[test]
    fn the_nearest_level_wins_and_no_press_is_lost() {
        let ladder = Ladder::new([Some(250), Some(500), Some(750)]).unwrap();
        for (reading, buttons) in [
            (240, 1),
            (250, 1),
            (309, 1),
            (500, 2),
            (740, 4),
            (375, ALL),
            (0, ALL),
            (1_023, ALL),
        ] {
            assert_eq!(down(true, Some(&ladder), reading), buttons, "{reading}");
            assert_eq!(down(false, Some(&ladder), reading), 0);
        }
    }

    #[test]
    fn an_unknown_ladder_makes_every_press_a_press_of_all() {
        assert_eq!(Ladder::new([Some(250), None, Some(750)]), None);
        assert_eq!(down(true, None, 500), ALL);
        assert_eq!(down(false, None, 500), 0);
    }
}
