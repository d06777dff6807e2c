//! The board of the SR8730, between the microcontroller's pins and the simulated home.
//!
//! The pins are read from `robots/samsung-sr8730/pinout.toml`; values that have not been measured come from the
//! calibration table of `robot.toml` beside it.

mod beams;
mod calibration;
mod circuit;
mod contacts;
mod display;
mod dock_code;
mod encoder;
mod error;
mod gyro;
mod gyro_frame;
mod light;
mod link;
mod motors;
pub mod pinout;
mod power;
mod robot;
pub mod serial;
pub mod wiring;

pub use calibration::{CalibrationValues, Particulars, RECORD_ADDRESS, put_record};
pub use contacts::{Contact, Hold};
pub use error::BoardError;
pub use gyro_frame::{GyroCheck, GyroFitted, GyroLayout};
pub use link::{BoardLink, I2cPlaces, SpiPlaces};
pub use motors::{DriveInterval, MotorOutput, Reaction, reaction};
pub use robot::{Blueprint, BlueprintError, CalibrationChoice, EmulatedRobot, EmulatedSettings};

/// Cycles of the chip's system clock in a second.
pub const CYCLES_PER_S: u64 = 80_000_000;
/// And in a millisecond, which is a step of the simulated home.
pub const CYCLES_PER_MS: u64 = 80_000;
