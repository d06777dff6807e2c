//! When a robot at work stands still for its gyro's sake: the bias is learnt at rest.

/// Time between two rests, microseconds.
const EVERY_US: u64 = 60_000_000;
/// Length of a rest, microseconds.
const REST_US: u64 = 2_000_000;

/// The next rest, or the one that is taken.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GyroRest {
    due_us: Option<u64>,
    until_us: Option<u64>,
}

impl GyroRest {
    /// Whether the robot shall stand still now. It is kept waiting only on a way ahead; what comes in between ends a rest, and
    /// that is taken anew as soon as the robot is on its way again.
    pub(super) fn follow(&mut self, now_us: u64, is_ahead: bool) -> bool {
        if !is_ahead {
            self.until_us = None;
            return false;
        }
        let due_us = *self.due_us.get_or_insert(now_us + EVERY_US);
        if now_us < due_us {
            return false;
        }
        let until_us = *self.until_us.get_or_insert(now_us + REST_US);
        if now_us < until_us {
            return true;
        }
        *self = Self {
            due_us: Some(now_us + EVERY_US),
            until_us: None,
        };
        false
    }
}

#[cfg(test)]
mod tests {
    use super::{EVERY_US, GyroRest, REST_US};

    #[test]
    fn a_rest_is_taken_on_the_first_way_ahead_after_it_is_due_and_whole() {
        let mut rest = GyroRest::default();
        assert!(!rest.follow(0, true));
        assert!(!rest.follow(EVERY_US - 1, true));
        let late_us = EVERY_US + 20_000_000;
        assert!(!rest.follow(late_us, false), "it turns");
        assert!(rest.follow(late_us + 1, true));
        assert!(!rest.follow(late_us + 2, false), "something was met");
        assert!(rest.follow(late_us + 3, true));
        assert!(rest.follow(late_us + 2 + REST_US, true));
        assert!(!rest.follow(late_us + 3 + REST_US, true));
        assert!(!rest.follow(late_us + EVERY_US, true));
        assert!(rest.follow(late_us + 3 + REST_US + EVERY_US, true));
    }
}
