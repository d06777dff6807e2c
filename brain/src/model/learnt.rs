//! Calibration that a robot learns. It outlives maps, jobs and the shell.

use super::energy::EnergyModel;

/// Largest accepted errors of a gyro: no working one exceeds them.
pub(crate) struct GyroLimits {
    /// Greatest scale error, relative.
    pub(crate) scale_max: f64,
    /// Greatest standard deviation of the scale error, relative.
    pub(crate) scale_sigma_max: f64,
    /// Greatest bias, radians per second.
    pub(crate) bias_max_rad_per_s: f64,
}

pub(crate) const GYRO_LIMITS: GyroLimits = GyroLimits {
    scale_max: 0.05,
    scale_sigma_max: 0.01,
    bias_max_rad_per_s: 0.03,
};

/// Calibration of the gyro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroLearnt {
    /// Relative error of the scale.
    pub scale: f64,
    /// Standard deviation of the scale error.
    pub scale_sigma: f64,
    /// Bias, rad/s.
    pub bias_rad_per_s: f64,
}

impl GyroLearnt {
    /// The same, if it is within the limits.
    #[must_use]
    pub fn checked(self) -> Option<Self> {
        // Written so that NaN is refused.
        let is_plausible = self.scale.abs() <= GYRO_LIMITS.scale_max
            && (0.0..=GYRO_LIMITS.scale_sigma_max).contains(&self.scale_sigma)
            && self.bias_rad_per_s.abs() <= GYRO_LIMITS.bias_max_rad_per_s;
        is_plausible.then_some(self)
    }
}

/// Everything that the robot has learnt.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Learnt {
    /// `None` = not learnt yet.
    pub gyro: Option<GyroLearnt>,
    /// Energy consumption of driving and cleaning.
    pub energy: EnergyModel,
}

/// A part of what the robot has learnt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LearntPart {
    /// Calibration of the gyro.
    Gyro,
    /// Energy consumption of driving and cleaning.
    Energy,
}

#[cfg(test)]
mod tests {
    use super::GyroLearnt;

    const GYRO: GyroLearnt = GyroLearnt {
        scale: 0.012,
        scale_sigma: 0.001,
        bias_rad_per_s: -2e-3,
    };

    #[test]
    fn implausible_calibrations_are_refused() {
        assert_eq!(GYRO.checked(), Some(GYRO));
        for wrong in [
            GyroLearnt { scale: 0.2, ..GYRO },
            GyroLearnt {
                scale: f64::NAN,
                ..GYRO
            },
            GyroLearnt {
                scale_sigma: -0.001,
                ..GYRO
            },
            GyroLearnt {
                scale_sigma: f64::NAN,
                ..GYRO
            },
            GyroLearnt {
                bias_rad_per_s: 1.0,
                ..GYRO
            },
        ] {
            assert_eq!(wrong.checked(), None, "{wrong:?}");
        }
    }
}
