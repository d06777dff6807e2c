//! Estimates of the gyro's errors.

/// Estimated errors of the gyro.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GyroEstimate {
    /// Scale error, relative, and its standard deviation.
    pub(super) scale: f64,
    pub(super) scale_sigma: f64,
    /// Bias and its standard deviation, radians per second.
    pub(super) bias_rad_per_s: f64,
    pub(super) bias_sigma_rad_per_s: f64,
}

/// Bias as a zero-velocity update measured it.
#[derive(Clone, Copy, Debug)]
pub(super) struct BiasMeasurement {
    pub(super) rad_per_s: f64,
    pub(super) variance_rad2_per_s2: f64,
}

impl BiasMeasurement {
    /// Combines two measurements.
    pub(super) fn and(self, other: Self) -> Self {
        let sum = self.variance_rad2_per_s2 + other.variance_rad2_per_s2;
        let own = other.variance_rad2_per_s2 / sum;
        Self {
            rad_per_s: own * self.rad_per_s + (1.0 - own) * other.rad_per_s,
            variance_rad2_per_s2: own * self.variance_rad2_per_s2,
        }
    }
}
