//! What must survive a restart of the daemon, as plain data. The shell serializes it.

use core::task::Poll;

use crate::behavior::JobCheckpoint;
use crate::localization::TrackingCheckpoint;
use crate::mapping::{Hazard, PathPoint, StoredMap, SweptRun};
use crate::model::energy::EnergyModel;
use crate::model::geometry::Pose2;
use crate::model::gradual::Gradual;
use crate::model::learnt::{GyroLearnt, Learnt};
use crate::model::map_doubt::MapDoubt;

/// State of a brain that can be taken up again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checkpoint {
    /// Pose in the map.
    pub pose: Pose2,
    /// State of the random generator.
    pub random_state: u64,
    /// Reverse travel in metres that no forward travel has compensated.
    pub backed_m: f64,
    /// The job that ran or waited, if there was one.
    pub job: Option<JobCheckpoint>,
    /// Swept cells in rows.
    pub swept: Vec<SweptRun>,
    /// The path so far.
    pub path: Vec<PathPoint>,
    /// Contacts and cliffs so far.
    pub hazards: Vec<Hazard>,
    /// The map of the home; `None` = none, or the reader has it already.
    pub home: Option<StoredMap>,
    /// Learnt energy use of driving and cleaning.
    pub energy: EnergyModel,
    /// What was learnt of the gyro; `None` = nothing that is worth keeping.
    pub gyro: Option<GyroLearnt>,
    /// State of localization in the map of the home; `None` = odometry alone.
    pub tracking: Option<TrackingCheckpoint>,
    /// Why the map of the home is doubted in this run; `None` = it is not.
    pub map_doubt: Option<MapDoubt>,
}

/// A checkpoint in the making: copying the home takes several steps.
#[derive(Debug)]
pub struct CheckpointWork {
    /// All but the home.
    pub(crate) rest: Checkpoint,
    pub(crate) home: Gradual<StoredMap>,
}

impl CheckpointWork {
    /// Does the next step. The checkpoint that it returns in the end is of the state at the beginning; it must not be called again
    /// after that.
    pub fn go_on(&mut self) -> Option<Checkpoint> {
        let Poll::Ready(home) = self.home.go_on() else {
            return None;
        };
        Some(Checkpoint {
            home: Some(home).filter(|home| !home.is_blank()),
            ..core::mem::take(&mut self.rest)
        })
    }
}

impl Checkpoint {
    /// The same, with what was learnt before wherever the checkpoint has nothing newer.
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
    use super::Checkpoint;
    use crate::model::energy::EnergyModel;
    use crate::model::learnt::{GyroLearnt, Learnt};

    const GYRO: GyroLearnt = GyroLearnt {
        scale: 0.012,
        scale_sigma: 0.001,
        bias_rad_per_s: -2e-3,
    };

    #[test]
    fn a_checkpoint_has_precedence_over_what_was_learnt_before() {
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
