//! The wire between a robot's microcontroller and its Linux board. `protocol/SPEC.md` is the normative text.
//!
//! From the line upwards: [`frame`] splits bytes into packets, [`crc`] detects damaged ones, `text` and `binary`
//! convert them to the closed types of [`message`] and back, [`session`] keeps the state of each end, [`quality`]
//! measures the line; [`fill`] is for lines that only the host clocks. No allocation, no recursion, no clock, no panic on any input; work per byte is constant.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod binary;
mod buffer;
pub mod crc;
pub mod fill;
pub mod frame;
pub mod message;
#[cfg_attr(
    not(test),
    warn(clippy::arithmetic_side_effects, reason = "it counts what comes from outside")
)]
pub mod quality;
pub mod session;
pub mod span;
pub mod text;

pub use buffer::{EncodeError, PACKET_BUFFER_BYTES, PacketBuffer};
