//! Errors of building a board.

use crate::pins::UnknownPin;

/// What is wrong with the description of a board.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BoardError {
    /// The file is not what it should be.
    #[error("pinout.toml is not valid: {0}; robots/README.md tells the format")]
    Format(String),
    /// A signal's port is no pin.
    #[error("pinout.toml: signal `{signal}`: {cause}")]
    Port {
        /// Name of the signal.
        signal: String,
        /// What is wrong with its port.
        cause: UnknownPin,
    },
    /// The emulated board needs a signal that is not there.
    #[error("pinout.toml: there is no signal `{0}`, which the board needs")]
    NoSignal(&'static str),
    /// A signal has an unknown active level where the level matters.
    #[error("pinout.toml: `{0}` must have an active level, high or low")]
    NoLevel(&'static str),
}
