//! The wire between a robot's microcontroller and its Linux board. `protocol/SPEC.md` is the normative text.
//!
//! From the line upwards: [`frame`] cuts bytes into packets, [`crc`] tells whole packets from damaged ones, `text` and
//! `binary` turn them into the closed types of [`message`] and back, [`session`] holds the conversation, [`quality`] judges
//! the line. No allocation, no recursion, no clock, no panic on any input; work per byte is constant.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod binary;
mod buffer;
pub mod crc;
pub mod frame;
pub mod message;
pub mod quality;
pub mod session;
pub mod span;
pub mod text;

pub use buffer::{EncodeError, PACKET_BUFFER_BYTES, PacketBuffer};
