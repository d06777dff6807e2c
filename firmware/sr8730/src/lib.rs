//! The board of the Samsung Navibot SR8730.
//!
//! [`logic`] holds what can be decided without a chip. The program around it (`main.rs`) joins it to the pins.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[cfg(test)]
extern crate std;

pub mod logic;
