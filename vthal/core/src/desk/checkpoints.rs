//! Checkpoints for the disk, made in steps while the robot drives.

use brain::{BehaviorState, CheckpointWork};

use rvac_api::RunRecord;

use crate::Checkpoint;
use crate::brain_session::BrainSession;

/// Pause between two checkpoints of a small map.
const CHECKPOINT_US: u64 = 1_000_000;
/// Each entry of the map lengthens that pause by this much, so that a large one does not wear out the disk.
const CHECKPOINT_US_PER_ENTRY: u64 = 100;

/// When the next one is due, and the one that is being made.
#[derive(Debug, Default)]
pub(crate) struct CheckpointClock {
    next_us: u64,
    had_job: bool,
    in_progress: Option<CheckpointInProgress>,
}

/// A checkpoint of which the home is still being written down.
#[derive(Debug)]
struct CheckpointInProgress {
    /// All but the brain.
    rest: Checkpoint,
    brain: CheckpointWork,
}

impl CheckpointInProgress {
    fn go_on(&mut self) -> Option<Checkpoint> {
        let brain = self.brain.go_on()?;
        Some(Checkpoint {
            brain,
            ..self.rest.clone()
        })
    }
}

impl CheckpointClock {
    /// Makes a checkpoint when one is due, and goes on with one that is being made. `run` is the record of the run that goes on.
    pub(crate) fn follow(
        &mut self,
        now_us: u64,
        brain_session: &BrainSession,
        run: impl FnOnce() -> Option<RunRecord>,
    ) -> Option<Checkpoint> {
        let has_job = works(brain_session);
        if self.had_job && !has_job {
            // What is on the disk would let the robot go on by itself after a power cut, though somebody has stopped it.
            self.in_progress = None;
            self.next_us = now_us;
        }
        if let Some(work) = &mut self.in_progress {
            let checkpoint = work.go_on()?;
            self.in_progress = None;
            return Some(checkpoint);
        }
        if now_us < self.next_us {
            return None;
        }
        if has_job || self.had_job {
            self.had_job = has_job;
            self.in_progress = Some(CheckpointInProgress {
                rest: Checkpoint {
                    device: brain_session.device().to_owned(),
                    floor: brain_session.floor(),
                    brain: brain::Checkpoint::default(),
                    run: run().map(Box::new),
                },
                brain: brain_session.brain().begin_checkpoint(),
            });
        }
        let map = brain_session.brain().map().snapshot();
        let home_cells = brain_session.brain().map().knowledge().values().len();
        let entries = (map.swept.len() / 8 + map.path.len() + map.hazards.len() + home_cells / 8) as u64;
        self.next_us = now_us + CHECKPOINT_US + entries * CHECKPOINT_US_PER_ENTRY;
        None
    }
}

/// Whether a job runs or waits.
pub(crate) fn works(brain_session: &BrainSession) -> bool {
    let status = brain_session.brain().status();
    let active = matches!(
        status.state,
        BehaviorState::Starting
            | BehaviorState::Cleaning
            | BehaviorState::Spot
            | BehaviorState::Going
            | BehaviorState::Docking
    );
    active || status.resumable || brain_session.brain().waits_on_dock()
}

/// Pose and map without a job: an orderly end is not an interruption.
pub(crate) fn checkpoint_without_job(brain_session: &BrainSession) -> Checkpoint {
    let brain = brain::Checkpoint {
        job: None,
        ..brain_session.brain().checkpoint()
    };
    Checkpoint {
        device: brain_session.device().to_owned(),
        floor: brain_session.floor(),
        brain,
        run: None,
    }
}
