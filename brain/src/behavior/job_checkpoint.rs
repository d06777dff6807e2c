//! The part of a job that must survive a restart of the daemon.

use super::{JobFigures, JobKind};
use crate::model::order::CleaningOrder;

/// A job that ran or waited.
#[derive(Clone, Debug, PartialEq)]
pub struct JobCheckpoint {
    /// Its purpose.
    pub kind: JobKind,
    /// What the job cleans, or the job that resumes after it.
    pub order: CleaningOrder,
    /// What it had done.
    pub figures: JobFigures,
    /// It was in motion or about to be, so it resumes by itself; otherwise it waits for a person.
    pub running: bool,
    /// The job that resumes when this one has brought the robot to its dock and the pack is charged.
    pub goes_on: Option<JobKind>,
}
