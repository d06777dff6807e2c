//! What the gyro shows at standstill is its bias: it is learnt whenever the wheels rest, and taken off.
//!
//! One number with one variance, a Kalman filter of the smallest kind. Between rests the variance grows with the drift of
//! the bias; a rest weighs the more the longer it lasts.

use super::odometry::Totals;

/// Noise of the heading, rad per square root of a second: 0.02 degrees, usual for MEMS gyros.
const WALK_RAD_PER_SQRT_S: f64 = 3.5e-4;
/// Growth of the bias's variance, (rad/s)^2 per second: 0.001 degrees per second per square root of a second.
const DRIFT_RAD2_PER_S3: f64 = 3.0e-10;
/// Variance before anything is known, (rad/s)^2: a bias of some tenths of a degree a second.
const UNKNOWN_RAD2_PER_S2: f64 = 2.5e-5;
/// After the last encoder count the robot still swings out for so long.
const SETTLE_S: f64 = 0.3;
/// Rests shorter than this, the swinging out not counted, tell nothing.
const REST_MIN_S: f64 = 0.3;
/// Rests are weighed in pieces of this length at most.
const REST_MAX_S: f64 = 2.0;
/// A rest that differs by more deviations than this counts the less the more it does: the bias of a gyro wanders slowly.
const GATE: f64 = 4.0;
/// A faster turn at resting wheels is a person who turns the robot, or a bump that pushed it.
const CARRIED_RAD_PER_S: f64 = 0.03;

/// Estimate of the bias.
#[derive(Clone, Debug)]
pub(super) struct GyroBias {
    bias_rad_per_s: f64,
    variance: f64,
    rest: Option<Rest>,
}

/// Wheels that stand.
#[derive(Clone, Copy, Debug)]
struct Rest {
    began_us: u64,
    /// What was seen at the beginning of the present piece.
    since: Totals,
}

fn seconds(from_us: u64, to: Totals) -> f64 {
    to.time_us.saturating_sub(from_us) as f64 * 1e-6
}

impl Default for GyroBias {
    fn default() -> Self {
        Self {
            bias_rad_per_s: 0.0,
            variance: UNKNOWN_RAD2_PER_S2,
            rest: None,
        }
    }
}

impl GyroBias {
    /// Goes on with a bias that was learnt before; it may have wandered since.
    pub(super) fn resumed(bias_rad_per_s: f64) -> Self {
        let believable = bias_rad_per_s.abs() <= CARRIED_RAD_PER_S;
        Self {
            bias_rad_per_s: if believable { bias_rad_per_s } else { 0.0 },
            ..Self::default()
        }
    }

    /// The bias in rad/s.
    pub(super) fn rad_per_s(&self) -> f64 {
        self.bias_rad_per_s
    }

    /// Whether the wheels have rested for so long that the robot has swung out, and nobody turns it.
    pub(super) fn stands_still(&self, now: Totals, seen_rad: f64, time_s: f64) -> bool {
        let rests = self
            .rest
            .is_some_and(|rest| rest.since.wheels_agree_with(now) && seconds(rest.began_us, now) > SETTLE_S);
        rests && seen_rad.abs() <= CARRIED_RAD_PER_S * time_s
    }

    /// Takes in the totals of an observation that came `time_s` after the one before.
    pub(super) fn observe(&mut self, now: Totals, time_s: f64) {
        self.variance += DRIFT_RAD2_PER_S3 * time_s;
        let Some(rest) = self.rest.filter(|rest| rest.since.wheels_agree_with(now)) else {
            self.rest = Some(Rest {
                began_us: now.time_us,
                since: now,
            });
            return;
        };
        let settled = seconds(rest.began_us, now) > SETTLE_S;
        let piece_s = seconds(rest.since.time_us, now);
        if settled && piece_s >= REST_MAX_S {
            self.learn(rest.since, now, piece_s);
        }
        if !settled || piece_s >= REST_MAX_S {
            self.rest = Some(Rest { since: now, ..rest });
        }
    }

    /// The wheels begin to turn: what was rested so far counts.
    pub(super) fn end_rest(&mut self, last: Totals) {
        let Some(rest) = self.rest.take() else { return };
        let piece_s = seconds(rest.since.time_us, last);
        if piece_s >= REST_MIN_S {
            self.learn(rest.since, last, piece_s);
        }
    }

    fn learn(&mut self, since: Totals, now: Totals, rested_s: f64) {
        let (Some(from_rad), Some(to_rad)) = (since.gyro_rad, now.gyro_rad) else {
            return;
        };
        let seen_rad_per_s = (to_rad - from_rad) / rested_s;
        // Written so that NaN is not learnt.
        let believable = seen_rad_per_s.abs() <= CARRIED_RAD_PER_S;
        if !believable {
            return;
        }
        let noise = WALK_RAD_PER_SQRT_S * WALK_RAD_PER_SQRT_S / rested_s;
        let off_rad_per_s = seen_rad_per_s - self.bias_rad_per_s;
        let surprise = off_rad_per_s * off_rad_per_s / (GATE * GATE * (self.variance + noise));
        // A robot that slides along what it touches turns slowly, too, while its wheels rest.
        let gain = self.variance / (self.variance + noise) / surprise.max(1.0);
        self.bias_rad_per_s += gain * off_rad_per_s;
        self.variance *= 1.0 - gain;
    }
}

#[cfg(test)]
mod tests {
    use super::{GyroBias, Totals};

    fn at(time_s: f64, left_m: f64, gyro_rad: f64) -> Totals {
        Totals {
            time_us: (time_s * 1e6) as u64,
            left_m,
            right_m: left_m,
            gyro_rad: Some(gyro_rad),
        }
    }

    #[test]
    fn a_rest_tells_the_bias_and_a_person_who_turns_the_robot_does_not() {
        let mut bias = GyroBias::default();
        for step in 0..200 {
            let time_s = f64::from(step) * 0.02;
            bias.observe(at(time_s, 1.0, 0.001 * time_s), 0.02);
        }
        assert!((bias.rad_per_s() - 0.001).abs() < 5e-5, "{}", bias.rad_per_s());
        let learnt = bias.rad_per_s();
        for step in 0..300 {
            let time_s = 4.0 + f64::from(step) * 0.02;
            bias.observe(at(time_s, 1.0, 0.5 * time_s), 0.02);
        }
        assert!((bias.rad_per_s() - learnt).abs() < 5e-5, "{}", bias.rad_per_s());
    }

    #[test]
    fn a_robot_that_is_turned_slowly_at_rest_does_not_unlearn_the_bias() {
        let mut bias = GyroBias::default();
        let rest = |bias: &mut GyroBias, from_s: f64, rested_s: f64, rad_per_s: f64| {
            for step in 0..=(rested_s / 0.02) as u32 {
                let time_s = from_s + f64::from(step) * 0.02;
                bias.observe(at(time_s, from_s, rad_per_s * time_s), 0.02);
            }
            bias.end_rest(at(from_s + rested_s, from_s, rad_per_s * (from_s + rested_s)));
        };
        rest(&mut bias, 0.0, 5.0, 0.001);
        let learnt = bias.rad_per_s();
        rest(&mut bias, 100.0, 1.0, 0.02);
        assert!((bias.rad_per_s() - learnt).abs() < 1e-4, "{}", bias.rad_per_s());
        // One that has really changed is learnt all the same.
        for minute in 2..20 {
            rest(&mut bias, 100.0 * f64::from(minute), 2.0, 0.004);
        }
        assert!((bias.rad_per_s() - 0.004).abs() < 1e-3, "{}", bias.rad_per_s());
    }

    #[test]
    fn a_short_rest_counts_when_it_ends() {
        let mut bias = GyroBias::default();
        for step in 0..=50 {
            let time_s = f64::from(step) * 0.02;
            bias.observe(at(time_s, 1.0, 0.002 * time_s), 0.02);
        }
        assert_eq!(bias.rad_per_s(), 0.0);
        bias.end_rest(at(1.0, 1.0, 0.002));
        assert!((bias.rad_per_s() - 0.002).abs() < 1e-4, "{}", bias.rad_per_s());
    }
}
