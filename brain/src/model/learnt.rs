//! What a robot has learnt of itself: it outlives every map, every job, and the shell.

use super::energy::EnergyModel;

/// Largest scale error, its deviation and bias that are believed of somebody else's word: more is no gyro that works.
const SCALE_MAX: f64 = 0.05;
const SCALE_SIGMA_MAX: f64 = 0.01;
const BIAS_MAX_RAD_PER_S: f64 = 0.03;

/// What is wrong with the gyro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroLearnt {
    /// Error of its scale, relative.
    pub scale: f64,
    /// Standard deviation of that.
    pub scale_sigma: f64,
    /// Its bias, rad/s.
    pub bias_rad_per_s: f64,
}

impl GyroLearnt {
    /// Itself, if it can be.
    #[must_use]
    pub fn checked(self) -> Option<Self> {
        // Written so that NaN cannot be.
        let can_be = self.scale.abs() <= SCALE_MAX
            && (0.0..=SCALE_SIGMA_MAX).contains(&self.scale_sigma)
            && self.bias_rad_per_s.abs() <= BIAS_MAX_RAD_PER_S;
        can_be.then_some(self)
    }
}

/// All that it has learnt.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Learnt {
    /// `None` = nothing that is worth keeping.
    pub gyro: Option<GyroLearnt>,
    /// What driving and cleaning take from the pack.
    pub energy: EnergyModel,
}

/// A part of what it has learnt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LearntPart {
    /// What is wrong with the gyro.
    Gyro,
    /// What driving and cleaning take from the pack.
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
    fn what_no_gyro_can_be_is_not_believed() {
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
