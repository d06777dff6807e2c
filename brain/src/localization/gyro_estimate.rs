//! What is believed of the gyro, and what a rest says of it.

/// What is believed of the gyro.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GyroEstimate {
    /// Error of the scale, relative, and its deviation.
    pub(super) scale: f64,
    pub(super) scale_sigma: f64,
    /// Bias and its deviation, radians per second.
    pub(super) bias_rad_per_s: f64,
    pub(super) bias_sigma_rad_per_s: f64,
}

/// What a rest says of the bias.
#[derive(Clone, Copy, Debug)]
pub(super) struct BiasMeasurement {
    pub(super) rad_per_s: f64,
    pub(super) variance_rad2_per_s2: f64,
}

impl BiasMeasurement {
    /// What both say together.
    pub(super) fn and(self, other: Self) -> Self {
        let sum = self.variance_rad2_per_s2 + other.variance_rad2_per_s2;
        let own = other.variance_rad2_per_s2 / sum;
        Self {
            rad_per_s: own * self.rad_per_s + (1.0 - own) * other.rad_per_s,
            variance_rad2_per_s2: own * self.variance_rad2_per_s2,
        }
    }
}
