//! The shell of the vthal daemon: it carries out what `vthal-core` decides, and decides nothing itself.
//!
//! One event loop ([`daemon`]) over one closed enum ([`event`]); the link to the robot ([`link`], [`serial`]) and each client of the socket
//! ([`socket`], [`client`], [`outbox`]) are tasks that only turn bytes into events; a gyro on the board ([`imu`]), and its buttons and lights ([`board`]), are read by threads. Disks are slow, so recordings
//! ([`recording`]) and checkpoints ([`checkpoint_file`]) are written by threads of their own.
#![forbid(unsafe_code)]

mod archive_desk;
pub mod board;
mod calibration_thread;
pub mod checkpoint_file;
mod checkpoint_thread;
mod client;
mod client_stream;
mod clock;
pub mod config;
mod daemon;
mod event;
mod floor_archive;
mod floor_folder;
mod health_file;
pub mod imu;
mod instance;
mod kept_store;
mod learnt_file;
mod lifetime_file;
mod link;
mod load_meter;
mod logging;
#[cfg_attr(
    not(test),
    warn(clippy::arithmetic_side_effects, reason = "it counts what comes from outside")
)]
mod map_folder;
mod map_trials;
mod mix_folder;
#[cfg_attr(
    not(test),
    warn(clippy::arithmetic_side_effects, reason = "it counts what comes from outside")
)]
mod numbered;
mod outbox;
pub mod radio;
pub mod recording;
mod robot_file;
mod rotation;
mod run_desk;
#[cfg_attr(
    not(test),
    warn(clippy::arithmetic_side_effects, reason = "it counts what comes from outside")
)]
mod run_folder;
mod run_thread;
mod schedule_file;
mod serial;
mod serial_identity;
mod service;
mod socket;
mod systemd;
mod told_lines;
mod zone;

pub use clock::Clock;
pub use kept_store::KeptStore;
pub use service::{ServeError, serve};
