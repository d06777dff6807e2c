//! Recordings of runs: one MCAP file each, which Foxglove opens and [`replay`] runs again. A run during which the daemon began
//! anew has several, which become one for whoever wants to read it.

mod false_refusals;
pub mod format;
mod foxglove;
mod library;
mod records;
pub mod replay;
mod run_file;
mod schemas;
mod thread;
mod track;
mod whole;

pub use library::{Library, LibraryLimits};
pub use run_file::{RecordError, RunFile};
pub use thread::{RecorderHandle, start};
pub use track::track;
pub use whole::{Part, Whole};

/// Channel of the run's beginning.
pub(crate) const RUN: &str = "/run";
/// Channel of the brain's observations.
pub(crate) const OBSERVATIONS: &str = "/observations";
/// Channel of the commands that the brain was given.
pub(crate) const COMMANDS: &str = "/commands";
/// Channel of the brain's answers; each is valid until the next.
pub(crate) const DECISIONS: &str = "/decisions";
/// Channel of the wire's packets.
pub(crate) const PACKETS: &str = "/packets";
/// Channel of the status as clients see it.
pub(crate) const STATUS: &str = "/status";
/// Channel of the device table.
pub(crate) const DEVICE: &str = "/device";
/// Channel of the pose, for Foxglove.
pub(crate) const POSE: &str = "/pose";
/// Channel of the robot's frame in the map's, for Foxglove.
pub(crate) const TRANSFORM: &str = "/tf";
/// Channel of the robot's shape, for Foxglove.
pub(crate) const ROBOT: &str = "/robot";
/// Channel of the log, for Foxglove.
pub(crate) const LOG: &str = "/log";
