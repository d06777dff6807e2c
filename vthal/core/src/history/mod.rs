//! Records of runs: what a job was ordered to do, how it ended, and why it stopped in between.
//!
//! A *run* here is what people mean by it: one order, from the beeps to the dock, with all pauses, charging and restarts of the
//! daemon in between. [`RunFollower`] reads each step of the brain and writes the record. While the run goes on the record
//! so far is part of the [checkpoint](crate::Checkpoint), so that a crash loses little of it: [`cut_short`] makes of a
//! checkpoint that was not resumed the stored part of its run.

mod ending;
mod follower;
mod open_run;
mod picture;
#[cfg(test)]
mod tests;

pub(crate) use follower::{Asked, Moment, RunFollower};
pub(crate) use picture::BrainAtHome;

use rvac_api::{RunJob, RunRecord};

use crate::Checkpoint;

/// The run of a checkpoint that is not resumed, as it is to be stored; `None` if there was none.
#[must_use]
pub fn cut_short(checkpoint: Checkpoint) -> Option<RunRecord> {
    let mut record = *checkpoint.run?;
    record.run.floor = checkpoint.floor;
    let picture = match record.run.job {
        // The checkpoint also contains the path of the job before, and the two cannot be distinguished.
        RunJob::Dock | RunJob::GoTo => None,
        RunJob::Clean { .. } | RunJob::Spot => Some(picture::of_checkpoint(&checkpoint.brain)),
    };
    Some(RunRecord { picture, ..record })
}
