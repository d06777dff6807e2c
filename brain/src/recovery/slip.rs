//! Detects wheel slip from the difference of gyro and wheels (S14).

use super::parameters::SLIP;
use crate::model::advance::Advance;

/// How well the wheels grip the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Traction {
    /// Well, or unknown because there is no gyro.
    Good,
    /// They slip: drive slower.
    Slipping,
    /// They have slipped for too long: stop and report.
    Lost,
}

/// Compares gyro and wheels in windows.
#[derive(Clone, Debug, Default)]
pub(crate) struct SlipWatch {
    window_s: f64,
    difference_rad: f64,
    slipping_s: f64,
}

impl SlipWatch {
    pub(crate) fn judge(&mut self, advance: Advance) -> Traction {
        if let Some(gyro_turn_rad) = advance.gyro_turn_rad {
            self.difference_rad += gyro_turn_rad - advance.wheel_turn_rad;
        }
        self.window_s += advance.time_s;
        if self.window_s >= SLIP.window_s {
            let slips = self.difference_rad.abs() > SLIP.disagreement_rad;
            self.slipping_s = if slips {
                self.slipping_s + self.window_s
            } else {
                0.0
            };
            (self.window_s, self.difference_rad) = (0.0, 0.0);
        }
        if self.slipping_s > SLIP.patience_s {
            Traction::Lost
        } else if self.slipping_s > 0.0 {
            Traction::Slipping
        } else {
            Traction::Good
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{SlipWatch, Traction};
    use crate::model::advance::Advance;

    #[test]
    fn slip_slows_then_stops_and_good_grip_forgives() {
        let slip = Advance {
            time_s: 0.02,
            wheel_turn_rad: 0.02,
            gyro_turn_rad: Some(0.0),
            ..Advance::default()
        };
        let grip = Advance {
            gyro_turn_rad: Some(0.019),
            ..slip
        };
        let mut watch = SlipWatch::default();
        let judge = |watch: &mut SlipWatch, advance, seconds: u32| {
            (0..seconds * 50).map(|_| watch.judge(advance)).last()
        };
        assert_eq!(judge(&mut watch, slip, 1), Some(Traction::Slipping));
        assert_eq!(judge(&mut watch, grip, 1), Some(Traction::Good));
        assert_eq!(judge(&mut watch, slip, 4), Some(Traction::Slipping));
        assert_eq!(judge(&mut watch, slip, 2), Some(Traction::Lost));
    }

    #[test]
    fn without_a_gyro_no_slip_is_reported() {
        let advance = Advance {
            time_s: 1.0,
            wheel_turn_rad: 1.0,
            ..Advance::default()
        };
        assert_eq!(SlipWatch::default().judge(advance), Traction::Good);
    }
}
