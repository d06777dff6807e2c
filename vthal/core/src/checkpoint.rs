//! What survives a crash of the daemon.

use rvac_api::RunRecord;

/// The running job as far as it is needed to go on with it. The shell writes the newest one to disk and gives it back
/// through [`crate::CoreConfig::resume`] when it is young enough.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// Device it belongs to; another one does not take it up.
    pub device: String,
    /// Floor on which the robot was, if that was known.
    pub floor: Option<u16>,
    /// State of the brain.
    pub brain: brain::Checkpoint,
    /// The record of the run that goes on, as far as it was known.
    pub run: Option<Box<RunRecord>>,
}
