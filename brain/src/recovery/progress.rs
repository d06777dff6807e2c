//! Detects that a commanded robot does not move (S15).

use crate::model::action::Motion;
use crate::model::advance::Advance;

/// Not moving for this long means that the robot is stuck.
const PATIENCE_S: f64 = 2.0;
/// Distance that counts as moving.
const MOVED_M: f64 = 0.02;
/// Turn that counts as moving.
const TURNED_RAD: f64 = 0.1;
/// Slower commands are ignored: the dead band of a motor may swallow them.
const SPEED_MIN_M_PER_S: f64 = 0.03;
/// As `SPEED_MIN_M_PER_S`.
const TURN_MIN_RAD_PER_S: f64 = 0.25;

/// Compares commanded with actual movement.
#[derive(Clone, Debug, Default)]
pub(crate) struct ProgressWatch {
    commanded_s: f64,
    moved_m: f64,
    turned_rad: f64,
}

impl ProgressWatch {
    /// Updates with the movement that followed `commanded`; true when the robot is stuck.
    pub(crate) fn is_stuck(&mut self, commanded: Motion, advance: Advance) -> bool {
        let demanding = matches!(commanded, Motion::Drive { speed_m_per_s, turn_rad_per_s }
            if speed_m_per_s.abs() >= SPEED_MIN_M_PER_S || turn_rad_per_s.abs() >= TURN_MIN_RAD_PER_S);
        if !demanding {
            *self = Self::default();
            return false;
        }
        self.commanded_s += advance.time_s;
        self.moved_m += advance.distance_m;
        self.turned_rad += advance.turn_rad;
        if self.moved_m.abs() >= MOVED_M || self.turned_rad.abs() >= TURNED_RAD {
            *self = Self::default();
        }
        self.commanded_s >= PATIENCE_S
    }
}

#[cfg(test)]
mod tests {
    use super::ProgressWatch;
    use crate::model::action::Motion;
    use crate::model::advance::Advance;

    const FORWARD: Motion = Motion::Drive {
        speed_m_per_s: 0.25,
        turn_rad_per_s: 0.0,
    };

    fn steps_until_trouble(commanded: Motion, advance: Advance) -> Option<u32> {
        let mut watch = ProgressWatch::default();
        (1..=1000).find(|_| watch.is_stuck(commanded, advance))
    }

    #[test]
    fn standing_still_is_noticed_after_two_seconds() {
        let still = Advance {
            time_s: 0.02,
            ..Advance::default()
        };
        assert!(steps_until_trouble(FORWARD, still).is_some_and(|steps| (100..=101).contains(&steps)));
        assert_eq!(steps_until_trouble(Motion::Halt, still), None);
    }

    #[test]
    fn moving_or_turning_is_progress() {
        let moving = Advance {
            time_s: 0.02,
            distance_m: 0.001,
            ..Advance::default()
        };
        let turning = Advance {
            time_s: 0.02,
            turn_rad: -0.004,
            ..Advance::default()
        };
        assert_eq!(steps_until_trouble(FORWARD, moving), None);
        assert_eq!(
            steps_until_trouble(
                Motion::Drive {
                    speed_m_per_s: 0.0,
                    turn_rad_per_s: -0.4
                },
                turning
            ),
            None
        );
    }
}
