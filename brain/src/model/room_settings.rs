//! How a room is cleaned when nobody says it otherwise.

use super::edit_error::EditError;

/// Most passes over a part.
pub(crate) const PASSES_MAX: u8 = 3;

/// How a room is cleaned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RoomSettings {
    passes: u8,
    power: RoomPower,
    pattern: Pattern,
}

/// In which way floor is swept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pattern {
    /// Straight lanes side by side.
    #[default]
    Lines,
    /// Rings along walls and furniture, from the wall inwards.
    Contour,
}

/// How hard brushes and suction run, in percent. What a robot lacks is ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RoomPower {
    /// Suction.
    pub suction: u8,
    /// The main brush.
    pub main_brush: u8,
    /// The side brushes.
    pub side_brushes: u8,
}

impl RoomPower {
    /// As in a room without settings.
    pub const FULL: Self = Self {
        suction: 100,
        main_brush: 100,
        side_brushes: 100,
    };

    /// Whether a robot can clean so: no share beyond 100 percent, and something runs.
    pub(crate) fn is_possible(self) -> bool {
        let shares = [self.suction, self.main_brush, self.side_brushes];
        shares.iter().all(|share| *share <= 100) && shares.iter().any(|share| *share > 0)
    }
}

impl Default for RoomSettings {
    fn default() -> Self {
        Self {
            passes: 1,
            power: RoomPower::FULL,
            pattern: Pattern::Lines,
        }
    }
}

impl RoomSettings {
    /// 1 to 3 passes at least, whenever a job names the room, and this power; swept in lines.
    ///
    /// # Errors
    /// [`EditError::BadSettings`] for another number of passes, more than 100 percent, or when nothing would run.
    pub fn new(passes: u8, power: RoomPower) -> Result<Self, EditError> {
        if power.is_possible() && (1..=PASSES_MAX).contains(&passes) {
            Ok(Self {
                passes,
                power,
                pattern: Pattern::Lines,
            })
        } else {
            Err(EditError::BadSettings)
        }
    }

    /// The same, swept by this pattern.
    #[must_use]
    pub const fn with_pattern(self, pattern: Pattern) -> Self {
        Self { pattern, ..self }
    }

    /// In which way it is swept.
    #[must_use]
    pub const fn pattern(&self) -> Pattern {
        self.pattern
    }

    /// How often it is cleaned at least.
    #[must_use]
    pub const fn passes(&self) -> u8 {
        self.passes
    }

    /// How hard brushes and suction run.
    #[must_use]
    pub const fn power(&self) -> RoomPower {
        self.power
    }
}

#[cfg(test)]
mod tests {
    use super::{RoomPower, RoomSettings};
    use crate::model::edit_error::EditError;

    #[test]
    fn what_no_robot_can_do_is_refused() {
        let none = RoomPower {
            suction: 0,
            main_brush: 0,
            side_brushes: 0,
        };
        let quiet = RoomPower { suction: 30, ..none };
        let settings = RoomSettings::new(3, quiet).unwrap();
        assert_eq!((settings.passes(), settings.power()), (3, quiet));
        assert_eq!(RoomSettings::new(1, RoomPower::FULL), Ok(RoomSettings::default()));
        let too_much = RoomPower {
            main_brush: 101,
            ..RoomPower::FULL
        };
        for (passes, power) in [(0, quiet), (4, quiet), (1, none), (1, too_much)] {
            assert_eq!(RoomSettings::new(passes, power), Err(EditError::BadSettings));
        }
    }
}
