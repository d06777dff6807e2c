//! What the brain has learnt about the robot: its gyro and its energy use.

use super::Brain;
use crate::model::learnt::{Learnt, LearntPart};

impl Brain {
    /// Discards what was learnt about one part, because the gyro or the pack was replaced.
    pub fn forget(&mut self, part: LearntPart) {
        match part {
            LearntPart::Gyro => self.forget_gyro(),
            LearntPart::Energy => self.begin_with(Learnt::default()),
        }
    }

    /// What was learnt up to now.
    #[must_use]
    pub fn learnt(&self) -> Learnt {
        Learnt {
            gyro: self.learnt_gyro(),
            energy: self.energy(),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::brain::Brain;
    use crate::model::config::BrainConfig;
    use crate::model::energy::EnergyModel;
    use crate::model::learnt::{GyroLearnt, Learnt, LearntPart};

    const GYRO: GyroLearnt = GyroLearnt {
        scale: 0.012,
        scale_sigma: 0.001,
        bias_rad_per_s: -2e-3,
    };

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
}
