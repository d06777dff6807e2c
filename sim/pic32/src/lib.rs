//! A PIC32MX360F256L that runs a firmware image, and the board of the SR8730 around it.
//!
//! Time is counted in cycles of the 80 MHz system clock since power-on. There is no clock, no I/O and no randomness of its
//! own: the same image and the same calls give the same bits.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod board;
