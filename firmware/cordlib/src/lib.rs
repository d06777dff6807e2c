//! What the firmware of every robot shares: the main loop, the reflexes, motion control, telemetry.
//!
//! A board supplies its parts (see [`board`]), constructs a [`Cord`] and calls [`Cord::step`] for ever. Memory is fixed,
//! there is no heap, no floating point, and no path that panics. `cargo run -p cordlib
//! --example size` prints what it costs.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod board;
mod cord;
mod parameters;

pub use cord::Cord;
pub use parameters::{GuardParameters, MotionParameters, Parameters, WheelParameters};
