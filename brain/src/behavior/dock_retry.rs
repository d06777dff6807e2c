//! A first run that left much of the home unreached retries once from its dock.
//!
//! A distorted map can enclose the robot: a wall drawn from a wrong pose closes a door. On the dock the pose is known, the map is redrawn
//! with it, and the blocked parts are mostly open then.

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
    /// The job resumes from the dock.
    pub(super) fn begins(&mut self) {
        if *self == Self::Due {
            *self = Self::Done;
        }
    }
}
