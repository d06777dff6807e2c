//! Detects that a commanded robot does not move (S15).

use super::parameters::PROGRESS;
use crate::model::action::Motion;
use crate::model::advance::Advance;

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
            if speed_m_per_s.abs() >= PROGRESS.speed_min_m_per_s || turn_rad_per_s.abs() >= PROGRESS.turn_min_rad_per_s);
        if !demanding {
            *self = Self::default();
            return false;
        }
        self.commanded_s += advance.time_s;
        self.moved_m += advance.distance_m;
        self.turned_rad += advance.turn_rad;
        if self.moved_m.abs() >= PROGRESS.moved_m || self.turned_rad.abs() >= PROGRESS.turned_rad {
            *self = Self::default();
        }
        self.commanded_s >= PROGRESS.patience_s
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
