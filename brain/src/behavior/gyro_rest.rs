//! When a robot at work rests so that its gyro's bias can be measured.

/// How often and how long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RestPace {
    /// Time between two rests, microseconds.
    every_us: u64,
    /// Length of a rest, microseconds.
    rest_us: u64,
}

impl RestPace {
    /// Without a map, only rests distinguish a turn from a bias.
    const UNTRACKED: Self = Self {
        every_us: 60_000_000,
        rest_us: 2_000_000,
    };
    /// With a map that corrects the heading as well, longer rests cost time and do not improve the pose.
    const TRACKED: Self = Self {
        every_us: 120_000_000,
        rest_us: 1_500_000,
    };

    /// The pace for a robot that localizes in a known map, or for any other.
    pub(super) const fn of(is_tracked: bool) -> Self {
        if is_tracked {
            Self::TRACKED
        } else {
            Self::UNTRACKED
        }
    }
}

/// The next rest, or the present one.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GyroRest {
    due_us: Option<u64>,
    until_us: Option<u64>,
}

impl GyroRest {
    /// Whether the robot must rest now. It rests only while it drives forward. Anything else ends a rest, which is repeated in full as soon
    /// as the robot drives forward again.
    pub(super) fn follow(&mut self, now_us: u64, is_ahead: bool, budget: RestPace) -> bool {
        let RestPace { every_us, rest_us } = budget;
        if !is_ahead {
            self.until_us = None;
            return false;
        }
        let due_us = *self.due_us.get_or_insert(now_us + every_us);
        if now_us < due_us {
            return false;
        }
        let until_us = *self.until_us.get_or_insert(now_us + rest_us);
        if now_us < until_us {
            return true;
        }
        *self = Self {
            due_us: Some(now_us + every_us),
            until_us: None,
        };
        false
    }
}

#[cfg(test)]
mod tests {
    use super::{GyroRest, RestPace};

    const EVERY_US: u64 = RestPace::UNTRACKED.every_us;
    const REST_US: u64 = RestPace::UNTRACKED.rest_us;

    #[test]
    fn a_due_rest_is_taken_in_full_during_forward_travel() {
        let mut rest = GyroRest::default();
        let mut follow = |now_us, is_ahead| rest.follow(now_us, is_ahead, RestPace::of(false));
        assert!(!follow(0, true));
        assert!(!follow(EVERY_US - 1, true));
        let late_us = EVERY_US + 20_000_000;
        assert!(!follow(late_us, false), "it turns");
        assert!(follow(late_us + 1, true));
        assert!(!follow(late_us + 2, false), "a contact");
        assert!(follow(late_us + 3, true));
        assert!(follow(late_us + 2 + REST_US, true));
        assert!(!follow(late_us + 3 + REST_US, true));
        assert!(!follow(late_us + EVERY_US, true));
        assert!(follow(late_us + 3 + REST_US + EVERY_US, true));
    }

    #[test]
    fn a_map_makes_rests_rare() {
        let mut rest = GyroRest::default();
        let mut follow = |now_us| rest.follow(now_us, true, RestPace::of(true));
        assert!(!follow(0));
        assert!(!follow(2 * EVERY_US - 1));
        assert!(follow(2 * EVERY_US));
        assert!(!follow(2 * EVERY_US + REST_US));
    }
}
