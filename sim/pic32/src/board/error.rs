//! Errors of building a board.

use crate::pins::PinError;

/// What is wrong with the description of a board.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BoardError {
    /// A file is not what it should be.
    #[error("{origin} is not valid: {message}; robots/README.md tells the format")]
    Format {
        /// Which file.
        origin: &'static str,
        /// Where and what.
        message: String,
    },
    /// A signal's port is no pin.
    #[error("pinout.toml: signal `{signal}`: {cause}")]
    Port {
        /// Name of the signal.
        signal: String,
        /// What is wrong with its port.
        cause: PinError,
    },
    /// Two signals have the same name or the same pin.
    #[error("pinout.toml: `{second}` and `{first}` have the same name or the same pin")]
    Twice {
        /// The earlier one.
        first: String,
        /// The later one.
        second: String,
    },
    /// The emulated board needs a signal that is not there.
    #[error("pinout.toml: there is no signal `{0}`, which the board needs")]
    NoSignal(&'static str),
    /// A signal has an unknown active level where the level matters.
    #[error("pinout.toml: `{0}` must have an active level, high or low")]
    NoLevel(&'static str),
    /// An analog signal is not on an analog pin.
    #[error("pinout.toml: `{0}` is on a pin without an analog input")]
    NotAnalog(&'static str),
    /// A calibration value is missing.
    #[error("robot.toml: there is no calibration value `{0}`, which the board needs")]
    NoValue(&'static str),
    /// A calibration value cannot be true.
    #[error("robot.toml: calibration value `{name}` is {value}, outside of its range {low} to {high}")]
    Range {
        /// Its name.
        name: String,
        /// Its simulated value.
        value: i32,
        /// Least that can be true.
        low: i32,
        /// Greatest that can be true.
        high: i32,
    },
    /// There are more calibration values than the record can hold.
    #[error("robot.toml: {0} calibration values do not fit into the record of 4096 bytes")]
    TooMany(usize),
}
