//! What must survive a restart of the daemon, as plain data: the shell writes and reads it in a form of its own.

use core::task::Poll;

use crate::behavior::{JobFigures, JobKind};
use crate::energy::EnergyModel;
use crate::geometry::Pose2;
use crate::gradual::Gradual;
use crate::learnt::GyroLearnt;
use crate::mapping::{Mark, PathPoint, StoredMap, SweptRun};
use crate::order::CleaningOrder;

/// State of a brain that can be taken up again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checkpoint {
    /// Pose in the map.
    pub pose: Pose2,
    /// State of the random generator.
    pub random_state: u64,
    /// Way back in metres that no way forward has made good.
    pub backed_m: f64,
    /// The job that ran or waited, if there was one.
    pub job: Option<JobCheckpoint>,
    /// Swept cells in rows.
    pub swept: Vec<SweptRun>,
    /// The way so far.
    pub path: Vec<PathPoint>,
    /// Contacts and cliffs met so far.
    pub marks: Vec<Mark>,
    /// What is known of the home; `None` = nothing, or nothing that the one who takes it up does not know already.
    pub home: Option<StoredMap>,
    /// What driving and cleaning take from the pack.
    pub energy: EnergyModel,
    /// What was learnt of the gyro; `None` = nothing that is worth keeping.
    pub gyro: Option<GyroLearnt>,
    /// How the pose is followed in the map of the home; `None` = by odometry alone.
    pub tracking: Option<TrackingCheckpoint>,
}

/// A checkpoint that is being made: writing down the home takes some steps.
#[derive(Debug)]
pub struct CheckpointWork {
    /// All but the home.
    pub(crate) rest: Checkpoint,
    pub(crate) home: Gradual<StoredMap>,
}

impl CheckpointWork {
    /// Does the next step. What it gives in the end is the state at the beginning. Not to be called again after that.
    pub fn go_on(&mut self) -> Option<Checkpoint> {
        let Poll::Ready(home) = self.home.go_on() else {
            return None;
        };
        Some(Checkpoint {
            home: Some(home).filter(|home| !home.is_empty()),
            ..core::mem::take(&mut self.rest)
        })
    }
}

/// How sure a robot is of its pose in the map of its home, and what it has learnt of its gyro.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrackingCheckpoint {
    /// Standard deviation of the place, metres.
    pub sigma_m: f64,
    /// Standard deviation of the heading, radians.
    pub sigma_rad: f64,
    /// It did not know where it was.
    pub lost: bool,
    /// Error of the gyro's scale, relative.
    pub gyro_scale: f64,
    /// Bias of the gyro, rad/s.
    pub gyro_bias_rad_per_s: f64,
    /// Beams that must still tell something before it counts as known where it is.
    pub unconfirmed_beams: u32,
}

/// A job that ran or waited.
#[derive(Clone, Debug, PartialEq)]
pub struct JobCheckpoint {
    /// What for.
    pub kind: JobKind,
    /// What of the home the job cleans, or the one that goes on after it.
    pub order: CleaningOrder,
    /// What it had done.
    pub figures: JobFigures,
    /// It was in motion or about to be (then it goes on by itself), else it waited for a person.
    pub running: bool,
    /// The job that goes on when this one has brought the robot to its dock and the pack is charged.
    pub goes_on: Option<JobKind>,
}
