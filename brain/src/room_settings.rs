//! How a room is cleaned when nobody says it otherwise.

use crate::behavior::Reason;
use crate::order::PASSES_MAX;

/// How a room is cleaned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RoomSettings {
    passes: u8,
    power: RoomPower,
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
}

impl Default for RoomSettings {
    fn default() -> Self {
        Self {
            passes: 1,
            power: RoomPower::FULL,
        }
    }
}

impl RoomSettings {
    /// 1 to 3 passes at least, whenever a job names the room, and this power.
    ///
    /// # Errors
    /// [`Reason::BadSettings`] for another number of passes, more than 100 percent, or when nothing would run.
    pub fn new(passes: u8, power: RoomPower) -> Result<Self, Reason> {
        let shares = [power.suction, power.main_brush, power.side_brushes];
        let is_power = shares.iter().all(|share| *share <= 100) && shares.iter().any(|share| *share > 0);
        if is_power && (1..=PASSES_MAX).contains(&passes) {
            Ok(Self { passes, power })
        } else {
            Err(Reason::BadSettings)
        }
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
    use crate::behavior::Reason;

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
            assert_eq!(RoomSettings::new(passes, power), Err(Reason::BadSettings));
        }
    }
}
