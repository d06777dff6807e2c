//! Eight lights on five lines and two supplies.
//!
//! One supply is on at a time, each for every other millisecond, so that a light reaches half of the light it would have
//! alone. Brightness has eight levels, spread over eight turns of its group: the darkest level flashes 62 times a second,
//! which the eye does not see.

use rvac_units::Ratio;

/// Lights: done, auto, spot, repeat, home, and three bars of the battery.
pub const LIGHTS: u8 = 8;
/// Levels above dark.
const LEVELS: u8 = 8;

/// A supply and the lights behind it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Group {
    /// Lights 0 to 4 on lines 0 to 4.
    #[default]
    Main,
    /// Lights 5 to 7 on lines 2 to 4.
    Battery,
}

/// What the lines carry for a millisecond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LampLines {
    /// The supply that is on.
    pub group: Group,
    /// Lines that are high, bit by number.
    pub lines: u8,
}

#[derive(Clone, Copy, Debug, Default)]
struct Lamp {
    level: u8,
    sum: u8,
}

/// Brightness of all lights and the place in their round.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lamps {
    lamps: [Lamp; LIGHTS as usize],
    group: Group,
}

impl Lamps {
    /// Sets one light; a number that no light has does nothing. Anything above zero is at least the lowest level.
    pub fn set(&mut self, light: u8, brightness: Ratio) {
        if let Some(lamp) = self.lamps.get_mut(usize::from(light)) {
            // At most 8.
            lamp.level = brightness
                .millionths()
                .unsigned_abs()
                .div_ceil(1_000_000 / u32::from(LEVELS)) as u8;
        }
    }

    /// Whether any light is on: if not, the lines can stay as they are, off.
    #[must_use]
    pub fn any(&self) -> bool {
        self.lamps.iter().any(|lamp| lamp.level > 0)
    }

    /// The next millisecond: the other group's turn.
    pub fn change(&mut self) -> LampLines {
        self.group = match self.group {
            Group::Main => Group::Battery,
            Group::Battery => Group::Main,
        };
        let (lamps, first_line) = match self.group {
            Group::Main => (self.lamps.get_mut(..5), 0),
            Group::Battery => (self.lamps.get_mut(5..), 2),
        };
        let mut lines = 0;
        for (number, lamp) in lamps.into_iter().flatten().enumerate() {
            if lamp.turn() {
                lines |= 1 << (first_line + number);
            }
        }
        LampLines {
            group: self.group,
            lines,
        }
    }
}

impl Lamp {
    /// Whether the light is on in this turn: on in `level` of [`LEVELS`] turns, evenly spread.
    const fn turn(&mut self) -> bool {
        self.sum += self.level;
        let on = self.sum >= LEVELS;
        if on {
            self.sum -= LEVELS;
        }
        on
    }
}

#[cfg(test)]
mod tests {
    use super::{Group, Lamps};
    use rvac_units::Ratio;

    fn ratio(millionths: i32) -> Ratio {
        Ratio::from_millionths(millionths).unwrap()
    }

    /// Milliseconds of 160 in which each line of each group is on.
    fn shares(lamps: &mut Lamps) -> [[u32; 5]; 2] {
        let mut on = [[0; 5]; 2];
        for _ in 0..160 {
            let shown = lamps.change();
            let group = usize::from(shown.group == Group::Battery);
            for (line, count) in on[group].iter_mut().enumerate() {
                *count += u32::from(shown.lines >> line & 1);
            }
        }
        on
    }

    #[test]
    fn each_light_has_its_line_and_half_of_the_time() {
        for light in 0..8_u8 {
            let mut lamps = Lamps::default();
            lamps.set(light, Ratio::ONE);
            let mut expected = [[0; 5]; 2];
            if light < 5 {
                expected[0][usize::from(light)] = 80;
            } else {
                expected[1][usize::from(light) - 3] = 80;
            }
            assert_eq!(shares(&mut lamps), expected, "light {light}");
        }
    }

    #[test]
    fn brightness_is_linear_in_eight_levels() {
        for (millionths, on) in [
            (0, 0),
            (1, 10),
            (125_000, 10),
            (500_000, 40),
            (510_000, 50),
            (1_000_000, 80),
        ] {
            let mut lamps = Lamps::default();
            lamps.set(0, ratio(millionths));
            assert_eq!(shares(&mut lamps)[0][0], on, "{millionths}");
        }
    }

    #[test]
    fn the_darkest_level_flashes_without_long_gaps() {
        let mut lamps = Lamps::default();
        lamps.set(2, ratio(1));
        let mut gap = 0;
        for _ in 0..200 {
            let lit = lamps.change().lines != 0;
            gap = if lit { 0 } else { gap + 1 };
            assert!(gap < 16);
        }
    }

    #[test]
    fn no_such_light_does_nothing() {
        let mut lamps = Lamps::default();
        lamps.set(8, Ratio::ONE);
        assert!(!lamps.any());
    }
}
