//! Scale and bias of the gyro, learnt from a filter that knows the heading by the walls.
//!
//! Over some ten seconds the heading that the filter gained and the heading that the gyro counted differ by what is wrong
//! with the gyro: `gained = (1 + scale) * counted - bias * time`. A Kalman filter of these two numbers takes the difference
//! of each such window. What zero-rate updates learn ([`super::gyro_bias`]) is taken off before.

use super::Advance;

/// Length of a window in seconds.
const WINDOW_S: f64 = 20.0;
/// Deviations before anything is known: 1 % and what a zero-rate update leaves.
const SCALE_SIGMA: f64 = 0.008;
const BIAS_SIGMA_RAD_PER_S: f64 = 5.0e-4;
/// Deviation of a scale that was learnt before: the gyro was perhaps colder then.
const RESUMED_SIGMA: f64 = 0.002;
/// How fast the bias wanders, (rad/s)^2 per second: 0.0015 degrees per second per square root of a second.
const BIAS_DRIFT_RAD2_PER_S3: f64 = 7.0e-10;
/// A window that differs by more deviations than this is not believed.
const GATE: f64 = 3.5;
/// Largest scale error and bias that are believed.
const SCALE_MAX: f64 = 0.05;
const BIAS_MAX_RAD_PER_S: f64 = 0.01;

/// What is wrong with the gyro, and the window that is being filled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Calibration {
    scale: f64,
    bias_rad_per_s: f64,
    /// Covariance: of the scale, of both, of the bias.
    covariance: [f64; 3],
    window: Window,
}

/// What was counted and gained between two moments at which the heading was known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gain {
    pub(super) time_s: f64,
    pub(super) counted_rad: f64,
    pub(super) gained_rad: f64,
    /// Variance of what was gained, square radians.
    pub(super) variance_rad2: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Window {
    time_s: f64,
    counted_rad: f64,
    gained_rad: f64,
    /// Variance of the heading at the beginning, square radians; `None` = no window is open.
    variance_rad2: Option<f64>,
}

impl Default for Calibration {
    fn default() -> Self {
        Self {
            scale: 0.0,
            bias_rad_per_s: 0.0,
            covariance: [
                SCALE_SIGMA * SCALE_SIGMA,
                0.0,
                BIAS_SIGMA_RAD_PER_S * BIAS_SIGMA_RAD_PER_S,
            ],
            window: Window::default(),
        }
    }
}

impl Calibration {
    /// Goes on with a scale that was learnt before.
    pub(super) fn resumed(scale: f64) -> Self {
        let believable = scale.abs() <= SCALE_MAX;
        if !believable {
            return Self::default();
        }
        let [_, both, bias] = Self::default().covariance;
        Self {
            scale,
            covariance: [RESUMED_SIGMA * RESUMED_SIGMA, both, bias],
            ..Self::default()
        }
    }

    /// Error of the scale, relative, and bias that zero-rate updates have left, rad/s.
    pub(super) fn found(&self) -> (f64, f64) {
        (self.scale, self.bias_rad_per_s)
    }

    /// Deviation of the scale, relative.
    pub(super) fn scale_sigma(&self) -> f64 {
        libm::sqrt(self.covariance[0].max(0.0))
    }

    /// Deviation of the bias, rad/s.
    pub(super) fn bias_sigma_rad_per_s(&self) -> f64 {
        libm::sqrt(self.covariance[2].max(0.0))
    }

    /// The true turn for one that was counted in `time_s`.
    pub(super) fn corrected_rad(&self, counted_rad: f64, time_s: f64) -> f64 {
        counted_rad * (1.0 + self.scale) - self.bias_rad_per_s * time_s
    }

    /// What the gyro counted (already corrected) in one step.
    pub(super) fn count(&mut self, advance: Advance) {
        self.covariance[2] += BIAS_DRIFT_RAD2_PER_S3 * advance.time_s;
        match advance.gyro_turn_rad {
            Some(turn_rad) => {
                self.window.time_s += advance.time_s;
                self.window.counted_rad += turn_rad;
                self.window.gained_rad += turn_rad;
            }
            None => self.window = Window::default(),
        }
    }

    /// The filter turned the pose by `correction_rad`, and knows the heading with this variance.
    pub(super) fn correct(&mut self, correction_rad: f64, variance_rad2: f64) {
        self.window.gained_rad += correction_rad;
        let Some(began_rad2) = self.window.variance_rad2 else {
            self.window = Window {
                variance_rad2: Some(variance_rad2),
                ..Window::default()
            };
            return;
        };
        if self.window.time_s < WINDOW_S {
            return;
        }
        let Window {
            time_s,
            counted_rad,
            gained_rad,
            ..
        } = self.window;
        self.learn(Gain {
            time_s,
            counted_rad,
            gained_rad,
            variance_rad2: began_rad2 + variance_rad2,
        });
        self.window = Window {
            variance_rad2: Some(variance_rad2),
            ..Window::default()
        };
    }

    /// The filter lost its way: what it says of the heading is worth nothing.
    pub(super) fn interrupt(&mut self) {
        self.window = Window::default();
    }

    /// Takes in how the heading changed between two moments at which it was known.
    pub(super) fn learn(&mut self, gain: Gain) {
        let Gain {
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
        // Written so that NaN is not learnt.
        let believable = off_rad * off_rad <= GATE * GATE * variance;
        if !believable {
            return;
        }
        let (gain_scale, gain_bias) = (by_scale / variance, by_bias / variance);
        self.scale = (self.scale + gain_scale * off_rad).clamp(-SCALE_MAX, SCALE_MAX);
        self.bias_rad_per_s =
            (self.bias_rad_per_s + gain_bias * off_rad).clamp(-BIAS_MAX_RAD_PER_S, BIAS_MAX_RAD_PER_S);
        self.covariance = [
            ss - gain_scale * by_scale,
            sb - gain_scale * by_bias,
            bb - gain_bias * by_bias,
        ];
    }
}
