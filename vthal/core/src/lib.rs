//! The deterministic core of the vthal daemon: everything the daemon decides, and nothing it does.
//!
//! [`Core::handle`] takes one [`Input`] with the present time and appends to [`Outputs`] what the shell must perform:
//! bytes for the link, updates for clients, log entries, records. [`Core::next_wake_us`] says when it needs
//! [`Input::Wake`]. It uses no clock, no sockets and no files, so the daemon, a test and the batch simulator run the
//! same code.
//!
//! A telemetry report passes the parts in this order: [`device`] (the device model, what holds for every make, and
//! the makes), [`observe`] (reports to observations), `brain_session` (the brain and the borders of runs), back through `device` to the link.
//! Beside it stand the desks of `desk`: each owns one subject (who may command, what buttons mean, what clients follow, floors,
//! [`schedule`]s, runs, loads of motors, learned values, what clients receive and how often). `core` holds them all, routes inputs and
//! requests to them, and hands the facts of one to another. [`stored_map`] is the bytes of maps, [`api_forms`] are orders and places
//! as clients and recordings write them. A [`Checkpoint`] is what survives a crash.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod api_forms;
mod brain_session;
mod checkpoint;
mod config;
mod core;
mod desk;
pub mod device;
mod diary;
mod edges;
mod floors;
pub mod health;
mod history;
mod home_view;
mod input;
mod lacking;
pub mod learnt;
pub mod lifetime;
mod lights;
mod newest;
pub mod observe;
mod outputs;
mod refusal;
pub mod schedule;
pub mod stored_map;
mod stored_version;
mod storey_resolver;
mod swept_sigma;
mod to_api;

pub use checkpoint::Checkpoint;
pub use config::{Checkpoints, CoreConfig, ExpertAccess, Recording};
pub use core::Core;
pub use floors::KeptFloor;
pub use history::cut_short;
pub use input::{ClientId, Input, LinkLoss};
pub use lacking::{Ability, CalibrationValue, Lacking};
pub use lights::Lights;
pub use outputs::{
    ArchiveOrder, ArchiveTask, CalibrationOrder, CalibrationTask, Delivery, Direction, EditedMap, FloorHome,
    FloorOrder, FloorTask, HealthOrder, LearntOrder, LineHolder, MapOrder, MixOrder, MixTask, Outputs,
    Recipients, Record, RunCause, RunEnd, RunQuery, RunStart, RunTask, ScheduleOrder,
};
pub use stored_version::OtherVersion;
