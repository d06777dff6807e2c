//! What a robot has learnt of itself: it outlives every map, every job, and the shell.

use crate::brain::Brain;
use crate::checkpoint::Checkpoint;
use crate::energy::EnergyModel;

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

impl Brain {
    /// Forgets a part: the gyro was changed, or the pack.
    pub fn forget(&mut self, part: LearntPart) {
        match part {
            LearntPart::Gyro => self.forget_gyro(),
            LearntPart::Energy => self.begin_with(Learnt::default()),
        }
    }

    /// What the robot has learnt of itself up to now.
    #[must_use]
    pub fn learnt(&self) -> Learnt {
        Learnt {
            gyro: self.learnt_gyro(),
            energy: self.energy(),
        }
    }
}

impl Checkpoint {
    /// The same for a robot that has learnt this before, where the checkpoint knows nothing newer.
    #[must_use]
    pub fn after(self, learnt: Learnt) -> Self {
        let is_new = self.energy.seen_s > 0.0;
        Self {
            gyro: self.gyro.or(learnt.gyro),
            energy: if is_new { self.energy } else { learnt.energy },
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{GyroLearnt, Learnt, LearntPart};
    use crate::brain::Brain;
    use crate::checkpoint::Checkpoint;
    use crate::config::BrainConfig;
    use crate::energy::EnergyModel;

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

    #[test]
    fn each_part_is_forgotten_alone() {
        let energy = EnergyModel {
            seen_s: 600.0,
            ..EnergyModel::default()
        };
        let mut brain = Brain::new(BrainConfig::of_tests(), 1);
        brain.begin_with(Learnt {
            gyro: Some(GYRO),
            energy,
        });
        assert!(brain.learnt().gyro.is_some(), "{:?}", brain.learnt());
        brain.forget(LearntPart::Gyro);
        assert_eq!(brain.learnt(), Learnt { gyro: None, energy });
        brain.forget(LearntPart::Energy);
        assert_eq!(brain.learnt(), Learnt::default());
    }

    #[test]
    fn what_a_checkpoint_knows_is_the_newer() {
        let energy = EnergyModel {
            seen_s: 600.0,
            ..EnergyModel::default()
        };
        let learnt = Learnt {
            gyro: Some(GYRO),
            energy,
        };
        let after = Checkpoint::default().after(learnt);
        assert_eq!((after.gyro, after.energy), (Some(GYRO), energy));
        let newer = GyroLearnt { scale: 0.01, ..GYRO };
        let known = Checkpoint {
            gyro: Some(newer),
            ..Checkpoint::default()
        };
        assert_eq!(known.after(learnt).gyro, Some(newer));
    }
}
