//! What a drive beside the lanes asks of the job.

use crate::navigation::TaskStatus;

/// What to do after a step of a detour: a search for the heading, a relocalization, a fix of the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum DetourStep {
    /// None is needed: lanes go on.
    Idle,
    /// It has just ended: earlier plans are void.
    Over,
    /// It is in progress.
    Driving(TaskStatus),
}
