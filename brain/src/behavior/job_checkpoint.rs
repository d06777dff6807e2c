//! What of a job must survive a restart of the daemon.

use super::{JobFigures, JobKind};
use crate::model::order::CleaningOrder;

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
