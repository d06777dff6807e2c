//! A run that left much of the home unreached retries once from its dock.
//!
//! On a first run a distorted map can enclose the robot: a wall drawn from a wrong pose closes a door. On the dock the pose is known, the
//! map is redrawn with it, and the blocked parts are mostly open then. In a known home something came into the way during the job, mostly
//! somebody who stands in a door for some minutes. The robot waits for that on its dock, where it is in nobody's way.

/// Whether a job has retried from the dock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum DockRetry {
    /// Not yet.
    #[default]
    NotYet,
    /// As soon as it is on the dock.
    Due,
    /// It has retried.
    Done,
}

impl DockRetry {
    /// The job resumes from the dock. Gives whether it does so to retry.
    pub(super) fn begins(&mut self) -> bool {
        let is_due = *self == Self::Due;
        if is_due {
            *self = Self::Done;
        }
        is_due
    }
}
