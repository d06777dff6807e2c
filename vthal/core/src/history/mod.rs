//! Records of runs: what a job was asked for, what came of it, and why it stopped in between.
//!
//! A *run* here is what people mean by it: one order, from the beeps to the dock, with all pauses, charging and restarts of the
//! daemon in between. [`RunFollower`] looks at each step of the brain and makes the record. While the run goes on the record
//! so far is part of the [checkpoint](crate::Checkpoint), so that a crash loses little of it: [`cut_short`] makes of a
//! checkpoint that nobody took up what is kept of its run.

mod ending;
mod follower;
mod open_run;
mod picture;
#[cfg(test)]
mod tests;

pub(crate) use follower::{Asked, Moment, RunFollower};

use rvac_api::{RunJob, RunRecord};

use crate::Checkpoint;

/// The run of a checkpoint with which nobody goes on, as it is to be kept; `None` if there was none.
#[must_use]
pub fn cut_short(checkpoint: Checkpoint) -> Option<RunRecord> {
    let mut record = *checkpoint.run?;
    record.run.floor = checkpoint.floor;
    let picture = match record.run.job {
        // The checkpoint also contains the path of the job before, and the two cannot be told apart.
        RunJob::Dock => None,
        RunJob::Clean { .. } | RunJob::Spot => Some(picture::of_checkpoint(&checkpoint.brain)),
    };
    Some(RunRecord { picture, ..record })
}
