//! `rvac update`: a signed update on the Linux board and in the robot, or everything as it was before.
//!
//! Programs lie in two folders, A and B; the link `current` says which of them runs, and without it the package's own do. [`Updater`] is
//! the whole course: it verifies everything, fills the folder that is not in use, turns the link over, waits for programs and robot to
//! answer, writes the firmware, waits again, and goes back when they do not. Before each step that changes something it notes what it is
//! about to do, so that [`Updater::settle`] brings an update that was cut off to an end. Disk, board and chip are traits: trials cut them
//! off at every step. [`Fallback`] watches the daemon afterwards. How far an update is stands in a file that the panel's server reads.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod arguments;
mod board;
mod chip;
mod disk;
mod error;
mod fallback;
mod journal;
mod progress;
mod run;
mod services;
mod slots;
mod updater;
mod wired_chip;

pub use arguments::UpdateJob;
pub use board::{Board, BoardError, Health};
pub use chip::{Attempt, Chip, ChipError};
pub use disk::{Disk, RealDisk};
pub use error::UpdateError;
pub use fallback::{DaemonEnd, FAILURES_MAX, Fallback, Moment};
pub use journal::{Installed, Pending, PendingStep};
pub use run::run;
pub use slots::{Programs, Slot, Slots};
pub use updater::{Accepted, Outcome, Settled, UpdateStep, Updater, WayBack};
