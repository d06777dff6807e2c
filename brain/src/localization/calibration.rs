//! Calibrates scale and bias of the gyro, at rest and by headings that an estimator corrected.
//!
//! Over some ten seconds the true change of heading and the one that the gyro counted differ by the gyro's errors: `gained = (1 +
//! scale) * (counted - bias * time)`. A Kalman filter of these two numbers uses the difference of each such window, and the
//! zero-velocity updates ([`super::stationary`]). One filter does both, so that a later rest corrects a wrong bias from walls.

use super::gyro_estimate::{BiasMeasurement, GyroEstimate};
use super::stationary::StationaryInterval;
use crate::model::advance::Advance;
use crate::model::learnt::{GYRO_LIMITS, GyroLearnt};

/// Parameters of the gyro's calibration.
pub(super) struct CalibrationParameters {
    /// Length of a window, seconds.
    pub(super) window_s: f64,
    /// Prior standard deviation of the scale, relative: 1 %.
    pub(super) scale_sigma: f64,
    /// Prior standard deviation of the bias, radians per second: some tenths of a degree.
    pub(super) bias_sigma_rad_per_s: f64,
    /// Noise of the heading, radians per square root of a second: 0.03 degrees, between a usual gyro and a bad one.
    pub(super) walk_rad_per_sqrt_s: f64,
    /// Error of any rest by swinging and by the resolution of the gyro, radians.
    pub(super) swing_rad: f64,
    /// A rest that is off by more standard deviations than this loses weight, because the bias of a gyro changes slowly.
    pub(super) rest_gate_sigmas: f64,
    /// Possible change of a scale that was learned before: the gyro may have been colder.
    pub(super) resumed_sigma: f64,
    /// A scale with a larger standard deviation than this is not worth keeping.
    pub(super) learnt_sigma_max: f64,
    /// Random walk of the bias, (rad/s)^2 per second: 0.0015 degrees per second per square root of a second.
    pub(super) bias_drift_rad2_per_s3: f64,
    /// A window that is off by more standard deviations than this is rejected.
    pub(super) window_gate_sigmas: f64,
}

pub(super) const CALIBRATION: CalibrationParameters = CalibrationParameters {
    window_s: 20.0,
    scale_sigma: 0.008,
    bias_sigma_rad_per_s: 5.0e-3,
    walk_rad_per_sqrt_s: 5.0e-4,
    swing_rad: 8.0e-4,
    rest_gate_sigmas: 4.0,
    resumed_sigma: 0.002,
    learnt_sigma_max: 0.006,
    bias_drift_rad2_per_s3: 7.0e-10,
    window_gate_sigmas: 3.5,
};

/// Estimated errors of the gyro, and the window in progress.
#[derive(Clone, Copy, Debug)]
pub(super) struct Calibration {
    scale: f64,
    bias_rad_per_s: f64,
    /// Covariance: scale, both, bias.
    covariance: [f64; 3],
    window: CalibrationWindow,
}

/// Counted and true turn between two moments at which the heading was known.
#[derive(Clone, Copy, Debug)]
pub(super) struct HeadingGain {
    pub(super) time_s: f64,
    pub(super) counted_rad: f64,
    pub(super) gained_rad: f64,
    /// Variance of the true turn, square radians.
    pub(super) variance_rad2: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct CalibrationWindow {
    time_s: f64,
    counted_rad: f64,
    gained_rad: f64,
    /// Variance of the heading at the start, square radians; `None` = no window is open.
    variance_rad2: Option<f64>,
}

impl Default for Calibration {
    fn default() -> Self {
        Self {
            scale: 0.0,
            bias_rad_per_s: 0.0,
            covariance: [
                CALIBRATION.scale_sigma * CALIBRATION.scale_sigma,
                0.0,
                CALIBRATION.bias_sigma_rad_per_s * CALIBRATION.bias_sigma_rad_per_s,
            ],
            window: CalibrationWindow::default(),
        }
    }
}

impl Calibration {
    /// Starts with a scale and a bias that were learned before. The bias may have changed since.
    pub(super) fn resumed(learnt: GyroLearnt) -> Self {
        let GyroLearnt {
            scale, scale_sigma, ..
        } = learnt;
        let mut resumed = Self::default();
        if scale.abs() <= GYRO_LIMITS.scale_max && scale_sigma >= 0.0 {
            resumed.scale = scale;
            let variance = scale_sigma * scale_sigma + CALIBRATION.resumed_sigma * CALIBRATION.resumed_sigma;
            resumed.covariance[0] = variance.min(CALIBRATION.scale_sigma * CALIBRATION.scale_sigma);
        }
        if learnt.bias_rad_per_s.abs() <= GYRO_LIMITS.bias_max_rad_per_s {
            resumed.bias_rad_per_s = learnt.bias_rad_per_s;
        }
        resumed
    }

    /// What is worth keeping; `None` while the uncertainty is large.
    pub(super) fn learnt(&self) -> Option<GyroLearnt> {
        let scale_sigma = self.scale_sigma();
        (scale_sigma <= CALIBRATION.learnt_sigma_max).then_some(GyroLearnt {
            scale: self.scale,
            scale_sigma,
            bias_rad_per_s: self.bias_rad_per_s,
        })
    }

    /// The whole estimate.
    pub(super) fn belief(&self) -> GyroEstimate {
        GyroEstimate {
            scale: self.scale,
            scale_sigma: self.scale_sigma(),
            bias_rad_per_s: self.bias_rad_per_s,
            bias_sigma_rad_per_s: self.bias_sigma_rad_per_s(),
        }
    }

    /// An estimator that has used all measurements sets the calibration.
    pub(super) fn set(&mut self, belief: GyroEstimate) {
        self.set_scale(belief.scale, belief.scale_sigma);
        self.bias_rad_per_s = belief
            .bias_rad_per_s
            .clamp(-GYRO_LIMITS.bias_max_rad_per_s, GYRO_LIMITS.bias_max_rad_per_s);
        self.covariance[2] = belief.bias_sigma_rad_per_s * belief.bias_sigma_rad_per_s;
    }

    /// Scale error, relative, and bias, rad/s.
    pub(super) fn scale_and_bias(&self) -> (f64, f64) {
        (self.scale, self.bias_rad_per_s)
    }

    /// Standard deviation of the scale, relative.
    pub(super) fn scale_sigma(&self) -> f64 {
        libm::sqrt(self.covariance[0].max(0.0))
    }

    /// Standard deviation of the bias, rad/s.
    pub(super) fn bias_sigma_rad_per_s(&self) -> f64 {
        libm::sqrt(self.covariance[2].max(0.0))
    }

    /// The true turn for one that was counted in `time_s`.
    pub(super) fn corrected_rad(&self, counted_rad: f64, time_s: f64) -> f64 {
        (counted_rad - self.bias_rad_per_s * time_s) * (1.0 + self.scale)
    }

    /// Zero-velocity update: takes the turn rate at rest. Returns it as a measurement of the bias.
    pub(super) fn update_at_rest(&mut self, interval: StationaryInterval) -> BiasMeasurement {
        let [ss, sb, bb] = self.covariance;
        let swing_rad_per_s = CALIBRATION.swing_rad / interval.time_s;
        let noise = CALIBRATION.walk_rad_per_sqrt_s * CALIBRATION.walk_rad_per_sqrt_s / interval.time_s
            + swing_rad_per_s * swing_rad_per_s;
        let off_rad_per_s = interval.rad_per_s - self.bias_rad_per_s;
        let variance = bb + noise;
        let surprise = off_rad_per_s * off_rad_per_s
            / (CALIBRATION.rest_gate_sigmas * CALIBRATION.rest_gate_sigmas * variance);
        // A robot that slides along an obstacle turns slowly, too, while its wheels rest.
        let doubt = surprise.max(1.0);
        let weight = 1.0 / (variance * doubt);
        let (gain_scale, gain_bias) = (sb * weight, bb * weight);
        self.move_by(gain_scale * off_rad_per_s, gain_bias * off_rad_per_s);
        self.covariance = [ss - gain_scale * sb, sb - gain_scale * bb, bb - gain_bias * bb];
        BiasMeasurement {
            rad_per_s: interval.rad_per_s,
            variance_rad2_per_s2: variance * doubt - bb,
        }
    }

    /// An estimator that has used all measurements sets the scale.
    pub(super) fn set_scale(&mut self, scale: f64, sigma: f64) {
        self.scale = scale.clamp(-GYRO_LIMITS.scale_max, GYRO_LIMITS.scale_max);
        let [_, _, bias] = self.covariance;
        self.covariance = [sigma * sigma, 0.0, bias];
    }

    fn move_by(&mut self, scale: f64, bias_rad_per_s: f64) {
        self.scale = (self.scale + scale).clamp(-GYRO_LIMITS.scale_max, GYRO_LIMITS.scale_max);
        self.bias_rad_per_s = (self.bias_rad_per_s + bias_rad_per_s)
            .clamp(-GYRO_LIMITS.bias_max_rad_per_s, GYRO_LIMITS.bias_max_rad_per_s);
    }

    /// Takes the (already corrected) turn of one step.
    pub(super) fn count(&mut self, advance: Advance) {
        self.covariance[2] += CALIBRATION.bias_drift_rad2_per_s3 * advance.time_s;
        match advance.gyro_turn_rad {
            Some(turn_rad) => {
                self.window.time_s += advance.time_s;
                self.window.counted_rad += turn_rad;
                self.window.gained_rad += turn_rad;
            }
            None => self.window = CalibrationWindow::default(),
        }
    }

    /// An estimator turned the pose by `correction_rad`, and knows the heading with this variance.
    pub(super) fn correct(&mut self, correction_rad: f64, variance_rad2: f64) {
        self.window.gained_rad += correction_rad;
        let Some(began_rad2) = self.window.variance_rad2 else {
            self.window = CalibrationWindow {
                variance_rad2: Some(variance_rad2),
                ..CalibrationWindow::default()
            };
            return;
        };
        if self.window.time_s < CALIBRATION.window_s {
            return;
        }
        let CalibrationWindow {
            time_s,
            counted_rad,
            gained_rad,
            ..
        } = self.window;
        self.learn(HeadingGain {
            time_s,
            counted_rad,
            gained_rad,
            variance_rad2: began_rad2 + variance_rad2,
        });
        self.window = CalibrationWindow {
            variance_rad2: Some(variance_rad2),
            ..CalibrationWindow::default()
        };
    }

    /// The estimator is lost, so its heading is useless.
    pub(super) fn interrupt(&mut self) {
        self.window = CalibrationWindow::default();
    }

    /// Updates with the change of heading between two moments at which it was known.
    pub(super) fn learn(&mut self, gain: HeadingGain) {
        let HeadingGain {
            time_s,
            counted_rad,
            gained_rad,
            variance_rad2: noise_rad2,
        } = gain;
        let [ss, sb, bb] = self.covariance;
        let off_rad = gained_rad - counted_rad;
        let by_scale = ss * counted_rad - sb * time_s;
        let by_bias = sb * counted_rad - bb * time_s;
        let variance = counted_rad * by_scale - time_s * by_bias + noise_rad2;
        // Written so that NaN is rejected.
        let believable =
            off_rad * off_rad <= CALIBRATION.window_gate_sigmas * CALIBRATION.window_gate_sigmas * variance;
        if !believable {
            return;
        }
        let (gain_scale, gain_bias) = (by_scale / variance, by_bias / variance);
        self.move_by(gain_scale * off_rad, gain_bias * off_rad);
        self.covariance = [
            ss - gain_scale * by_scale,
            sb - gain_scale * by_bias,
            bb - gain_bias * by_bias,
        ];
    }
}

#[cfg(test)]
mod tests {
    use super::{CALIBRATION, Calibration, HeadingGain, StationaryInterval};
    use crate::localization::gyro_estimate::BiasMeasurement;
    use crate::model::learnt::GyroLearnt;

    fn measurement(rad_per_s: f64, sigma_rad_per_s: f64) -> BiasMeasurement {
        BiasMeasurement {
            rad_per_s,
            variance_rad2_per_s2: sigma_rad_per_s * sigma_rad_per_s,
        }
    }

    #[test]
    fn measurements_combine_by_their_variances() {
        let both = measurement(1e-3, 1e-4).and(measurement(2e-3, 1e-4));
        assert!((both.rad_per_s - 1.5e-3).abs() < 1e-12, "{both:?}");
        assert!((both.variance_rad2_per_s2 - 5e-9).abs() < 1e-18, "{both:?}");
        let both = measurement(1e-3, 1e-4).and(measurement(2e-3, 1e-2));
        assert!((both.rad_per_s - 1e-3).abs() < 1e-6, "{both:?}");
    }

    fn rests(calibration: &mut Calibration, times: u32, rad_per_s: f64) {
        for _ in 0..times {
            calibration.covariance[2] += 100.0 * CALIBRATION.bias_drift_rad2_per_s3;
            calibration.update_at_rest(StationaryInterval {
                rad_per_s,
                time_s: 2.0,
            });
        }
    }

    #[test]
    fn a_slow_turn_at_rest_does_not_change_the_bias() {
        let mut calibration = Calibration::default();
        rests(&mut calibration, 3, 0.001);
        let (_, learnt) = calibration.scale_and_bias();
        assert!((learnt - 0.001).abs() < 1e-4, "{learnt}");
        rests(&mut calibration, 1, 0.02);
        let (_, after) = calibration.scale_and_bias();
        assert!((after - learnt).abs() < 2e-4, "{after} after {learnt}");
        // A bias that has really changed is learned all the same.
        rests(&mut calibration, 20, 0.004);
        let (_, changed) = calibration.scale_and_bias();
        assert!((changed - 0.004).abs() < 5e-4, "{changed}");
    }

    #[test]
    fn a_wrong_bias_from_walls_is_corrected_by_rests() {
        let mut calibration = Calibration::default();
        rests(&mut calibration, 3, 0.001);
        for _ in 0..60 {
            calibration.learn(HeadingGain {
                time_s: 20.0,
                counted_rad: 0.1,
                gained_rad: 0.1 - 20.0 * 0.001,
                variance_rad2: 0.002,
            });
        }
        let (_, wrong) = calibration.scale_and_bias();
        assert!(wrong > 0.0014, "{wrong}");
        rests(&mut calibration, 20, 0.001);
        let (_, corrected) = calibration.scale_and_bias();
        assert!((corrected - 0.001).abs() < 2e-4, "{corrected}");
    }

    #[test]
    fn a_resumed_calibration_is_a_little_less_sure() {
        let fresh = Calibration::default();
        assert_eq!(fresh.learnt(), None, "nothing is known");
        let mut before = fresh;
        before.set_scale(0.012, 0.0005);
        before.move_by(0.0, 0.001);
        let learnt = before.learnt().expect("it is well known");
        let after = Calibration::resumed(learnt);
        assert_eq!(after.scale_and_bias(), before.scale_and_bias());
        assert!(after.scale_sigma() > before.scale_sigma());
        assert!((CALIBRATION.resumed_sigma..CALIBRATION.learnt_sigma_max).contains(&after.scale_sigma()));
        for scale_sigma in [0.5, f64::NAN] {
            let vague = Calibration::resumed(GyroLearnt {
                scale_sigma,
                ..learnt
            });
            assert!(
                (vague.scale_sigma() - CALIBRATION.scale_sigma).abs() < 1e-9,
                "never less sure than at first"
            );
        }
    }

    #[test]
    fn turns_calibrate_the_scale_and_straight_paths_the_bias() {
        let mut calibration = Calibration::default();
        for number in 0..40 {
            let counted_rad = if number % 2 == 0 { 6.0 } else { 0.0 };
            let (scale, bias) = calibration.scale_and_bias();
            let gained_rad = counted_rad * (1.0 + 0.01 - scale) - 20.0 * (0.002 - bias);
            calibration.learn(HeadingGain {
                time_s: 20.0,
                counted_rad,
                gained_rad,
                variance_rad2: 1e-4,
            });
        }
        let (scale, bias) = calibration.scale_and_bias();
        assert!((scale - 0.01).abs() < 5e-4, "{scale}");
        assert!((bias - 0.002).abs() < 5e-5, "{bias}");
    }
}
