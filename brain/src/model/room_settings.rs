//! Settings of a room, used when an order does not override them.

use super::edit_error::EditError;

/// Most passes over a part.
pub(crate) const PASSES_MAX: u8 = 3;

/// Settings of a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RoomSettings {
    passes: u8,
    power: RoomPower,
    pattern: Pattern,
}

/// Cleaning pattern.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pattern {
    /// Straight lanes side by side.
    #[default]
    Lines,
    /// Rings along walls and furniture, from the wall inwards.
    Contour,
}

/// Power of brushes and suction, in percent. Parts that the robot lacks are ignored.
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
    /// The power in a room without settings.
    pub const FULL: Self = Self {
        suction: 100,
        main_brush: 100,
        side_brushes: 100,
    };

    /// Whether the power is valid: no share above 100 percent, and at least one above 0.
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
    /// Settings with 1 to 3 passes at least, this power, and the pattern `Lines`.
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

    /// The same with another pattern.
    #[must_use]
    pub const fn with_pattern(self, pattern: Pattern) -> Self {
        Self { pattern, ..self }
    }

    /// The cleaning pattern.
    #[must_use]
    pub const fn pattern(&self) -> Pattern {
        self.pattern
    }

    /// Least number of passes.
    #[must_use]
    pub const fn passes(&self) -> u8 {
        self.passes
    }

    /// Power of brushes and suction.
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
    fn invalid_settings_are_refused() {
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
