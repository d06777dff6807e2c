//! Checkpoints for the disk, made in steps while the robot drives.

use brain::{BehaviorState, CheckpointWork};

use super::Core;
use crate::mind::Mind;
use crate::{Checkpoint, Checkpoints, Outputs};

/// Pause between two checkpoints of a small map.
const CHECKPOINT_US: u64 = 1_000_000;
/// Each entry of the map lengthens that pause by this much, so that a large one does not wear out the disk.
const CHECKPOINT_US_PER_ENTRY: u64 = 100;

/// When the next one is due, and the one that is being made.
#[derive(Debug, Default)]
pub(super) struct CheckpointClock {
    next_us: u64,
    had_job: bool,
    on_its_way: Option<CheckpointOnItsWay>,
}

/// A checkpoint of which the home is still being written down.
#[derive(Debug)]
struct CheckpointOnItsWay {
    /// All but the brain.
    rest: Checkpoint,
    brain: CheckpointWork,
}

impl CheckpointOnItsWay {
    fn go_on(&mut self) -> Option<Checkpoint> {
        let brain = self.brain.go_on()?;
        Some(Checkpoint {
            brain,
            ..self.rest.clone()
        })
    }
}

impl Core {
    /// Makes a checkpoint when one is due, and goes on with one that is being made.
    pub(super) fn follow_checkpoint(&mut self, now_us: u64, outputs: &mut Outputs) {
        let Some(mind) = &self.mind else { return };
        let off = self.config.checkpoints == Checkpoints::Off;
        if off || self.ended {
            return;
        }
        if let Some(work) = &mut self.checkpoints.on_its_way {
            if let Some(checkpoint) = work.go_on() {
                self.checkpoints.on_its_way = None;
                outputs.checkpoint = Some(checkpoint);
            }
            return;
        }
        if now_us < self.checkpoints.next_us {
            return;
        }
        let has_job = works(mind);
        if has_job || self.checkpoints.had_job {
            self.checkpoints.had_job = has_job;
            self.checkpoints.on_its_way = Some(CheckpointOnItsWay {
                rest: Checkpoint {
                    device: mind.device().to_owned(),
                    floor: mind.floor(),
                    brain: brain::Checkpoint::default(),
                    run: self.runs.so_far(now_us).map(Box::new),
                },
                brain: mind.brain().begin_checkpoint(),
            });
        }
        let map = mind.brain().map().snapshot();
        let home_cells = mind.brain().map().knowledge().values().len();
        let entries = (map.swept.len() / 8 + map.path.len() + map.hazards.len() + home_cells / 8) as u64;
        self.checkpoints.next_us = now_us + CHECKPOINT_US + entries * CHECKPOINT_US_PER_ENTRY;
    }
}

/// Whether a job runs or waits.
pub(super) fn works(mind: &Mind) -> bool {
    let status = mind.brain().status();
    let active = matches!(
        status.state,
        BehaviorState::Starting | BehaviorState::Cleaning | BehaviorState::Spot | BehaviorState::Docking
    );
    active || status.resumable
}

/// Pose and map without a job: an orderly end is not an interruption.
pub(super) fn checkpoint_without_job(mind: &Mind) -> Checkpoint {
    let brain = brain::Checkpoint {
        job: None,
        ..mind.brain().checkpoint()
    };
    Checkpoint {
        device: mind.device().to_owned(),
        floor: mind.floor(),
        brain,
        run: None,
    }
}
