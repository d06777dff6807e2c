//! A gyro with scale error, bias, drift and random walk.

use rvac_units::{Angle, AngularSpeed};

use super::sensors::GyroReading;
use super::wheel::STEP_S;
use crate::{Noise, Pcg, model};

/// Steps between two draws of the random walk.
pub(crate) const WALK_STEPS: u64 = 16;
const WALK_PERIOD_S: f64 = WALK_STEPS as f64 * STEP_S;
/// Steps between two steps of the bias.
pub(crate) const DRIFT_STEPS: u64 = 1024;
const DRIFT_PERIOD_S: f64 = DRIFT_STEPS as f64 * STEP_S;

/// The gyro.
#[derive(Clone, Debug)]
pub(crate) struct SimulatedGyro {
    steps_per_rad: f64,
    step_urad: f64,
    scale: f64,
    bias_rad_per_s: f64,
    walk_rad: f64,
    drift_rad_per_s: f64,
    wobble_rad_per_s: f64,
    heading_rad: f64,
    rate_rad_per_s: f64,
}

impl SimulatedGyro {
    pub(crate) fn new(part: &model::GyroModel, noise: &Noise, random: &mut Pcg) -> Self {
        Self {
            steps_per_rad: 1.0 / part.resolution_rad,
            step_urad: part.resolution_rad * 1e6,
            scale: 1.0 + noise.gyro_scale * random.normal(),
            bias_rad_per_s: noise.gyro_bias_rad_per_s * random.normal(),
            walk_rad: noise.gyro_walk_rad_per_sqrt_s * libm::sqrt(WALK_PERIOD_S),
            drift_rad_per_s: noise.gyro_drift_rad_per_s_sqrt_s * libm::sqrt(DRIFT_PERIOD_S),
            wobble_rad_per_s: 0.0,
            heading_rad: 0.0,
            rate_rad_per_s: 0.0,
        }
    }

    /// Advances one step in which the body turned by `turn_rad`.
    pub(crate) fn step(&mut self, turn_rad: f64) {
        let drift = (self.bias_rad_per_s + self.wobble_rad_per_s) * STEP_S;
        let seen = turn_rad * self.scale + drift;
        self.heading_rad += seen;
        // The module answers with about 100 Hz bandwidth.
        self.rate_rad_per_s += 0.3 * (seen * (1.0 / STEP_S) - self.rate_rad_per_s);
    }

    /// Draws the bias of another switch-on.
    pub(crate) fn switch_on(&mut self, noise: &Noise, random: &mut Pcg) {
        self.bias_rad_per_s = noise.gyro_bias_rad_per_s * random.normal();
    }

    /// What its turns must be multiplied by, less 1, to be true.
    pub(crate) fn scale_error(&self) -> f64 {
        1.0 / self.scale - 1.0
    }

    /// The bias changes by so much.
    pub(crate) fn shift_bias(&mut self, rad_per_s: f64) {
        self.bias_rad_per_s += rad_per_s;
    }

    /// Draws the random walk of the next [`WALK_PERIOD_S`].
    pub(crate) fn walk(&mut self, random: &mut Pcg) {
        self.wobble_rad_per_s = self.walk_rad / WALK_PERIOD_S * random.normal();
    }

    /// Moves the bias; every [`DRIFT_PERIOD_S`].
    pub(crate) fn drift(&mut self, random: &mut Pcg) {
        self.bias_rad_per_s += self.drift_rad_per_s * random.normal();
    }

    pub(crate) fn reading(&self) -> GyroReading {
        let steps = (self.heading_rad * self.steps_per_rad) as i64;
        // `as i32` on the wide integer wraps, as the register of such a module does.
        let heading = (steps as f64 * self.step_urad) as i64 as i32;
        GyroReading {
            heading: Angle(heading),
            rate: AngularSpeed((self.rate_rad_per_s * 1e6) as i32),
        }
    }
}
