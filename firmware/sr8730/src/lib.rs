//! The board of the Samsung Navibot SR8730.
//!
//! [`logic`] holds everything that can be decided without the chip, [`calibration`] the measured values of this robot,
//! [`board`] the parts on their pins, and [`robot`] puts it together with cordlib. The program is `main.rs`.
#![no_std]
#![deny(unsafe_code)]
#![deny(missing_docs)]

#[cfg(test)]
extern crate std;

#[allow(
    unsafe_code,
    reason = "symbols of interrupt handlers and one section of memory; there are no unsafe blocks"
)]
pub mod board;
pub mod calibration;
pub mod generated;
pub mod logic;
pub mod robot;
