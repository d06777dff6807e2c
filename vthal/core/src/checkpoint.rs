//! What survives a crash of the daemon.

use brain::command::StrategyName;
use rvac_api::Pose;

/// The running job as far as it is needed to go on with it. The shell writes the newest one to disk and gives it back
/// through [`crate::CoreConfig::resume`] when it is young enough.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// What was going on.
    pub job: Job,
    /// Where the robot believed to be.
    pub pose: Pose,
    /// Seconds of the job so far.
    pub job_s: f64,
}

/// What was going on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Job {
    /// Nothing that goes on by itself.
    None,
    /// Cleaning with the named strategy.
    Clean(StrategyName),
    /// Looking for the dock.
    Dock,
}
