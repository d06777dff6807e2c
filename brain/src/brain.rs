//! The brain as its shell sees it.

use crate::action::{Actions, Motion};
use crate::behavior::{BehaviorState, JobFigures, Reason, Status};
use crate::checkpoint::Checkpoint;
use crate::command::Command;
use crate::config::BrainConfig;
use crate::geometry::Pose2;
use crate::localization::Localization;
use crate::mapping::Map;
use crate::observation::Observation;

/// One robot's mind. Give it each observation and the commands that came since the last one; do what it answers.
#[derive(Debug)]
pub struct Brain {
    localization: Localization,
    map: Map,
    seed: u64,
}

impl Brain {
    /// A brain at the origin of an empty map, disconnected until the first observation says otherwise. Equal seeds and
    /// equal observations give equal actions.
    #[must_use]
    pub fn new(config: BrainConfig, seed: u64) -> Self {
        let rim_max_m_per_s =
            config.speeds.max_m_per_s + 0.5 * config.body.track_m * config.speeds.turn_max_rad_per_s;
        Self {
            localization: Localization::new(config.body.track_m, rim_max_m_per_s),
            map: Map::new(config.body.swath_m),
            seed,
        }
    }

    /// Takes in what the robot perceived and what people asked since the last step, and says what to do. To be called
    /// with each telemetry report, and at least ten times a second while the link is down so that the brain notices.
    pub fn step(&mut self, observation: &Observation, _commands: &[Command]) -> Actions {
        self.localization.update(observation);
        Actions {
            motion: Motion::Rest,
            cleaners: false,
            arm: None,
            tones: Vec::new(),
            decisions: Vec::new(),
        }
    }

    /// Whether `command` would be obeyed in the present situation. A shell asks this first, to answer its client.
    ///
    /// # Errors
    /// The named reason why it would be refused.
    pub fn admit(&self, _command: &Command) -> Result<(), Reason> {
        Ok(())
    }

    /// Pose in the map frame: the origin is where the robot stood at the start, x was forward.
    #[must_use]
    pub fn pose(&self) -> Pose2 {
        self.localization.pose()
    }

    /// What the robot is doing and why.
    #[must_use]
    pub fn status(&self) -> Status {
        Status {
            state: BehaviorState::Disconnected,
            reason: Reason::StartUp,
            strategy: None,
            resumable: false,
        }
    }

    /// The map of the running or last job.
    #[must_use]
    pub fn map(&self) -> &Map {
        &self.map
    }

    /// What the running or last job has done.
    #[must_use]
    pub fn job(&self) -> JobFigures {
        JobFigures::default()
    }

    /// Everything that must survive a restart of the shell. Costs about a millisecond per 100 m2 swept: for every few
    /// seconds, not for every step.
    #[must_use]
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            random_state: self.seed,
            ..Checkpoint::default()
        }
    }

    /// Takes up a checkpoint: the pose holds on from the next observation, a job that ran goes on by itself (announced as
    /// after any start) once the link is up, a job that waited waits on.
    pub fn restore(&mut self, checkpoint: &Checkpoint) {
        self.localization.place_at(checkpoint.pose);
        self.map
            .restore(&checkpoint.swept, &checkpoint.path, &checkpoint.marks);
    }
}
