//! Growth of the pose's uncertainty by odometry.

use crate::model::advance::Advance;

/// Standard deviations of a pose that odometry moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Drift {
    pub(super) sigma_m: f64,
    pub(super) sigma_rad: f64,
}

/// Noise of odometry. The figures come from navigation experiments of the project with robots of this class; no robot was
/// measured yet.
pub(super) struct OdometryNoise {
    /// Distance error of wheels that differ from the data sheet, relative.
    pub(super) distance_scale: f64,
    /// Slip, metres per square root of a metre.
    pub(super) slip_m_per_sqrt_m: f64,
    /// Slip in heading, radians per square root of a metre: 0.5 degrees, only without a gyro.
    pub(super) slip_rad_per_sqrt_m: f64,
    /// Turn error of the wheels, relative.
    pub(super) wheel_turn_scale: f64,
    /// Turn error of an uncalibrated gyro, relative.
    pub(super) gyro_turn_scale: f64,
    /// Noise of the gyro's heading, radians per square root of a second: 0.02 degrees.
    pub(super) gyro_walk_rad_per_sqrt_s: f64,
}

pub(super) const ODOMETRY_NOISE: OdometryNoise = OdometryNoise {
    distance_scale: 0.01,
    slip_m_per_sqrt_m: 0.01,
    slip_rad_per_sqrt_m: 8.7e-3,
    wheel_turn_scale: 0.015,
    gyro_turn_scale: 0.005,
    gyro_walk_rad_per_sqrt_s: 3.5e-4,
};

impl Drift {
    /// Adds the uncertainty of a motion. The heading error rotates the rest of the path, so this is the figure of a straight path
    /// and an upper bound for others.
    pub(super) fn grow(&mut self, advance: Advance) {
        let noise = &ODOMETRY_NOISE;
        let distance_m = advance.distance_m.abs();
        let turn_variance = turn_variance(advance);
        self.sigma_rad = libm::sqrt(self.sigma_rad * self.sigma_rad + turn_variance);
        let slipped_m2 = noise.slip_m_per_sqrt_m * noise.slip_m_per_sqrt_m * distance_m;
        self.sigma_m = libm::sqrt(self.sigma_m * self.sigma_m + slipped_m2)
            + distance_m
                * libm::sqrt(noise.distance_scale * noise.distance_scale + self.sigma_rad * self.sigma_rad);
    }
}

/// Variance that a motion adds to the heading, square radians. A robot at rest adds none, because odometry ignores the gyro then.
pub(super) fn turn_variance(advance: Advance) -> f64 {
    if advance.is_stationary() {
        return 0.0;
    }
    let noise = &ODOMETRY_NOISE;
    match advance.gyro_turn_rad {
        Some(turn_rad) => {
            let scale_rad = noise.gyro_turn_scale * turn_rad;
            scale_rad * scale_rad
                + noise.gyro_walk_rad_per_sqrt_s * noise.gyro_walk_rad_per_sqrt_s * advance.time_s
        }
        None => {
            let scale_rad = noise.wheel_turn_scale * advance.wheel_turn_rad;
            scale_rad * scale_rad
                + noise.slip_rad_per_sqrt_m * noise.slip_rad_per_sqrt_m * advance.distance_m.abs()
        }
    }
}
