//! The wire between a robot's microcontroller and its Linux board. `protocol/SPEC.md` is the normative text.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod message;
