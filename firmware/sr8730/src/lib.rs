//! The board of the Samsung Navibot SR8730.
//!
//! [`logic`] holds what can be decided without a chip, [`calibration`] what is known of this very robot. The program around
//! them (`main.rs`) joins both to the pins.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[cfg(test)]
extern crate std;

pub mod calibration;
pub mod generated;
pub mod logic;
