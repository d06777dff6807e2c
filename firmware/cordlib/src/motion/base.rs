//! From the velocity of the robot's base to the speeds of its wheels.

use rvac_protocol::message::Drive;

use crate::limit::within;
use crate::parameters::Parameters;
use crate::rules::cliff;

/// Velocity of the base.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct BaseVelocity {
    /// Forward, in µm/s.
    pub(crate) speed_um_per_s: i32,
    /// Counter-clockwise, in µrad/s.
    pub(crate) turn_urad_per_s: i32,
}

/// Speeds of the two rims, in µm/s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RimSpeeds {
    /// Left rim.
    pub(crate) left: i32,
    /// Right rim.
    pub(crate) right: i32,
}

impl From<&Drive> for BaseVelocity {
    fn from(drive: &Drive) -> Self {
        Self {
            speed_um_per_s: drive.speed.0,
            turn_urad_per_s: drive.turn.0,
        }
    }
}

impl BaseVelocity {
    /// The velocity one control period later, ramped towards `target`.
    pub(crate) fn ramp_to(self, target: Self, parameters: &Parameters, elapsed_ms: u32) -> Self {
        let elapsed_ms = i32::try_from(elapsed_ms).unwrap_or(i32::MAX);
        let step = |per_second: i32| (per_second / 1_000).saturating_mul(elapsed_ms);
        let motion = &parameters.motion;
        Self {
            speed_um_per_s: approach(
                self.speed_um_per_s,
                target.speed_um_per_s,
                step(motion.acceleration_um_per_s2),
            ),
            turn_urad_per_s: approach(
                self.turn_urad_per_s,
                target.turn_urad_per_s,
                step(motion.turn_acceleration_urad_per_s2),
            ),
        }
    }

    /// Speeds of the rims. If one is too fast, both are scaled down, so that the curvature stays the same.
    pub(crate) fn rims(self, parameters: &Parameters, near_cliff: bool) -> RimSpeeds {
        let half_track_um = i64::from(parameters.limits.track.0 / 2);
        let swing = i64::from(self.turn_urad_per_s).saturating_mul(half_track_um) / 1_000_000;
        let speed = i64::from(self.speed_um_per_s);
        let (left, right) = (speed.saturating_sub(swing), speed.saturating_add(swing));
        let limit = if near_cliff {
            cliff::SPEED_MAX_UM_PER_S
        } else {
            parameters.wheel.speed_at_full.0
        };
        let fastest = left.saturating_abs().max(right.saturating_abs()).max(1);
        let share = i64::from(limit).min(fastest);
        let scale = |speed: i64| {
            let scaled = speed.saturating_mul(share).checked_div(fastest);
            scaled.and_then(|speed| i32::try_from(speed).ok()).unwrap_or(0)
        };
        RimSpeeds {
            left: scale(left),
            right: scale(right),
        }
    }
}

fn approach(from: i32, to: i32, step: i32) -> i32 {
    within(to, from.saturating_sub(step), from.saturating_add(step))
}

#[cfg(test)]
mod tests {
    use super::{BaseVelocity, RimSpeeds};
    use crate::Parameters;
    use rvac_protocol::message::Limits;
    use rvac_units::{AngularSpeed, Length, Speed};

    fn parameters() -> Parameters {
        let limits = Limits {
            speed_max: Speed(350_000),
            turn_max: AngularSpeed(1_500_000),
            track: Length(200_000),
            count_nm: 400_000,
            radius: Length(175_000),
            swath: Length(300_000),
        };
        Parameters::for_machine("test", "0", limits)
    }

    #[test]
    fn a_left_turn_slows_the_left_rim() {
        let velocity = BaseVelocity {
            speed_um_per_s: 100_000,
            turn_urad_per_s: 500_000,
        };
        let rims = velocity.rims(&parameters(), false);
        assert_eq!(
            rims,
            RimSpeeds {
                left: 50_000,
                right: 150_000
            }
        );
    }

    #[test]
    fn too_fast_rims_are_slowed_alike() {
        let velocity = BaseVelocity {
            speed_um_per_s: -300_000,
            turn_urad_per_s: 1_000_000,
        };
        let rims = velocity.rims(&parameters(), true);
        assert_eq!(
            rims,
            RimSpeeds {
                left: -100_000,
                right: -50_000
            }
        );
    }

    #[test]
    fn extreme_velocities_saturate() {
        let velocity = BaseVelocity {
            speed_um_per_s: -i32::MAX,
            turn_urad_per_s: i32::MAX,
        };
        let rims = velocity.rims(&parameters(), false);
        assert!(rims.left < 0 && rims.left >= -parameters().wheel.speed_at_full.0);
        let next = velocity.ramp_to(BaseVelocity::default(), &parameters(), u32::MAX);
        assert_eq!(next, BaseVelocity::default());
    }
}
