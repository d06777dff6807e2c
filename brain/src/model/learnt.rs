//! Calibration that a robot learns. It outlives maps, jobs and the shell.

use super::energy::EnergyModel;

/// Limits for values from outside: no working gyro exceeds them.
const SCALE_MAX: f64 = 0.05;
const SCALE_SIGMA_MAX: f64 = 0.01;
const BIAS_MAX_RAD_PER_S: f64 = 0.03;

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
        let is_plausible = self.scale.abs() <= SCALE_MAX
            && (0.0..=SCALE_SIGMA_MAX).contains(&self.scale_sigma)
            && self.bias_rad_per_s.abs() <= BIAS_MAX_RAD_PER_S;
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
