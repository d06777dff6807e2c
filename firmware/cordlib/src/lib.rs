//! What the firmware of every robot shares: the main loop, the reflexes, motion control, telemetry.
//!
//! A board supplies its parts (see [`board`]), constructs a [`Cord`] and calls [`Cord::step`] for ever. Memory is fixed.
//! There is no heap, no floating point except in [`Cord::time_s`], and no path that panics. `cargo run -p cordlib
//! --example size` prints flash and memory use.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod arming;
pub mod board;
mod causes;
pub mod charge;
mod cleaning;
mod cord;
mod dispatch;
mod dock_escape;
mod fitted;
mod floor;
mod guarded;
mod identity;
mod journal;
mod kept;
mod lights;
mod limit;
mod motion;
mod parameters;
mod permit;
mod power;
mod probing;
mod rate;
mod react;
mod reflex;
mod report;
mod rules;
mod senses;
mod sound;
pub mod thermistor;
mod timing;
mod transmitter;
mod watch;

pub use cord::Cord;
pub use parameters::{
    GuardParameters, HandMode, LoadParameters, MotionParameters, PackParameters, Parameters, WheelParameters,
};
pub use permit::MotionPermit;
