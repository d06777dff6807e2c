//! What all bridges to other software share. A *bridge* is a program between the daemon and something that a home already has:
//! a broker, a collector of measurements, a service for notifications.
//!
//! [`Daemon`] is the connection, made again for ever. [`Knowledge`] is the newest of what came over it. [`picture`] draws the map of it.
//! [`FanSpeed`], [`DriveGate`] and [`Limiter`] are for those that take commands. [`dial`] is the way to others. [`service`] is how such a program starts and ends.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod daemon;
pub mod dial;
mod drive_gate;
mod fan_speed;
mod knowledge;
mod limiter;
pub mod picture;
pub mod rle;
pub mod service;

pub use daemon::{Daemon, News, NotSent};
pub use drive_gate::{DRIVE_SILENCE, DriveGate};
pub use fan_speed::FanSpeed;
pub use knowledge::{Change, Knowledge};
pub use limiter::{COMMANDS_MAX, Limiter};
