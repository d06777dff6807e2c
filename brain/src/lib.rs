//! Pure thinking: it takes what the robot perceived and what people asked, and says what the robot should do.
//!
//! No I/O, no clock, no randomness of its own: time comes with each [`Observation`], the seed with [`Brain::new`]. The
//! same calls give the same decisions, bit for bit, which is what replay rests on.
#![forbid(unsafe_code)]

pub mod action;
pub mod command;
pub mod observation;
