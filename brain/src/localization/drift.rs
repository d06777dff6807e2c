//! Growth of the pose's uncertainty by odometry.

use crate::model::advance::Advance;

/// Standard deviations of a pose that odometry moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Drift {
    pub(super) sigma_m: f64,
    pub(super) sigma_rad: f64,
}

/// Distance error of wheels that differ from the data sheet, relative. The figures of this file come from navigation experiments of
/// the project with robots of this class; no robot was measured yet.
const DISTANCE_SCALE: f64 = 0.01;
/// Slip, metres per square root of a metre.
const SLIP_M_PER_SQRT_M: f64 = 0.01;
/// Slip in heading, radians per square root of a metre: 0.5 degrees, only without a gyro.
const SLIP_RAD_PER_SQRT_M: f64 = 8.7e-3;
/// Turn error of the wheels, relative.
pub(super) const WHEEL_TURN_SCALE: f64 = 0.015;
/// Turn error of an uncalibrated gyro, relative.
const GYRO_TURN_SCALE: f64 = 0.005;
/// Noise of the gyro's heading, radians per square root of a second: 0.02 degrees.
const GYRO_WALK_RAD_PER_SQRT_S: f64 = 3.5e-4;

impl Drift {
    /// Adds the uncertainty of a motion. The heading error rotates the rest of the path, so this is the figure of a straight path
    /// and an upper bound for others.
    pub(super) fn grow(&mut self, advance: Advance) {
        let distance_m = advance.distance_m.abs();
        let turn_variance = turn_variance(advance);
        self.sigma_rad = libm::sqrt(self.sigma_rad * self.sigma_rad + turn_variance);
        let slipped_m2 = SLIP_M_PER_SQRT_M * SLIP_M_PER_SQRT_M * distance_m;
        self.sigma_m = libm::sqrt(self.sigma_m * self.sigma_m + slipped_m2)
            + distance_m * libm::sqrt(DISTANCE_SCALE * DISTANCE_SCALE + self.sigma_rad * self.sigma_rad);
    }
}

/// Variance that a motion adds to the heading, square radians. A robot at rest adds none, because odometry ignores the gyro then.
pub(super) fn turn_variance(advance: Advance) -> f64 {
    if advance.is_stationary() {
        return 0.0;
    }
    match advance.gyro_turn_rad {
        Some(turn_rad) => {
            let scale_rad = GYRO_TURN_SCALE * turn_rad;
            scale_rad * scale_rad + GYRO_WALK_RAD_PER_SQRT_S * GYRO_WALK_RAD_PER_SQRT_S * advance.time_s
        }
        None => {
            let scale_rad = WHEEL_TURN_SCALE * advance.wheel_turn_rad;
            scale_rad * scale_rad + SLIP_RAD_PER_SQRT_M * SLIP_RAD_PER_SQRT_M * advance.distance_m.abs()
        }
    }
}
