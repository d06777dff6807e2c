//! The deterministic core of the vthal daemon: everything the daemon decides, and nothing it does.
//!
//! [`Core::handle`] takes one [`Input`] with the present time and appends to [`Outputs`] what the shell must perform:
//! bytes for the link, updates for clients, log entries, records. [`Core::next_wake_us`] says when it wants
//! [`Input::Wake`]. It knows no clock, no sockets and no files, so the daemon, a test and the batch simulator run the
//! same code.
//!
//! The parts, in the way of a telemetry report: [`device`] (the device model, what holds for every make, and the makes),
//! [`observe`] (reports to observations), `mind` (the brain and the borders of runs), back through `device` to the link;
//! beside it the `arbiter` (who may command), `buttons` (what a person means who presses them), `client_inputs` (sticks that clients tell), [`schedule`] (what starts by itself), `history` (what is kept of runs), `core::feed` (what clients are told, and how often) and [`Checkpoint`]
//! (what survives a crash).
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod api_forms;
mod arbiter;
mod buttons;
mod checkpoint;
mod client_inputs;
mod clients;
mod config;
mod core;
pub mod device;
mod diary;
mod evidence;
mod floors;
pub mod health;
mod history;
mod home_view;
mod input;
mod journal;
pub mod learnt;
mod mind;
mod newest;
pub mod observe;
mod outputs;
mod quest;
pub mod schedule;
mod scheduler;
pub mod stored_map;
mod stored_version;
mod swept_sigma;
mod to_api;

pub use checkpoint::Checkpoint;
pub use config::{Checkpoints, CoreConfig, ExpertAccess, Recording};
pub use core::Core;
pub use floors::KeptFloor;
pub use history::cut_short;
pub use input::{ClientId, Input, LinkLoss};
pub use outputs::{
    ArchiveOrder, ArchiveTask, Delivery, Direction, FloorHome, FloorOrder, FloorTask, HealthOrder,
    LearntOrder, MapEdit, MapOrder, MixOrder, MixTask, Outputs, Recipients, Record, RunCause, RunEnd,
    RunQuery, RunStart, RunTask, ScheduleOrder,
};
pub use stored_version::OtherVersion;
