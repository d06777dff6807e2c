//! The board of the SR8730: what stands between the microcontroller's pins and the simulated home.
//!
//! Which pin does what is read from `robots/samsung-sr8730/pinout.toml`, what nobody has measured yet from the
//! calibration table of `robot.toml` beside it.

mod calibration;
mod error;
pub mod pinout;
pub mod serial;
pub mod wiring;

pub use calibration::{Calibration, Particulars, RECORD_ADDRESS, put_record};
pub use error::BoardError;

/// Cycles of the chip's system clock in a second.
pub const CYCLES_PER_S: u64 = 80_000_000;
/// And in a millisecond, which is a step of the simulated home.
pub const CYCLES_PER_MS: u64 = 80_000;
