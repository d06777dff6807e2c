//! The deterministic core of the vthal daemon: everything the daemon decides, and nothing it does.
//!
//! [`Core::handle`] takes one [`Input`] with the present time and appends to [`Outputs`] what the shell must perform:
//! bytes for the link, updates for clients, log entries, records. [`Core::next_wake_us`] says when it wants
//! [`Input::Wake`]. It knows no clock, no sockets and no files, so the daemon, a test and the batch simulator run the
//! same code.
//!
//! The parts, in the way of a telemetry report: [`link`] (session with the firmware), [`device`] (the device model and its
//! dead man), [`observe`] (reports to observations), the brain, back through `device` to the link; beside it the
//! [`arbiter`] (who may command), `feed` (what clients are told, and how often) and [`checkpoint`] (what survives a crash).
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod checkpoint;
mod config;
mod core;
mod input;
mod outputs;

pub use config::{CoreConfig, ExpertAccess, Recording};
pub use core::Core;
pub use input::{ClientId, Input, LinkLoss};
pub use outputs::{Delivery, Direction, Outputs, Recipients, Record, RunEnd, RunStart};
