//! The robot's chip, as far as an update needs it.

use rvac_api::Failure;

/// Why something was not done to the chip.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChipError {
    /// The file is no image for it.
    #[error("the firmware in the update: {0}")]
    Image(String),
    /// It cannot be reached.
    #[error("{0}")]
    Unreachable(String),
    /// The daemon says that the robot must not be disturbed now.
    #[error("{}", .0.text)]
    NotNow(Failure),
    /// What is in it cannot be kept.
    #[error("what is in the chip cannot be kept: {0}")]
    NotKept(String),
    /// It was not written.
    #[error("the chip was not written: {0}")]
    NotWritten(String),
}

/// Whether somebody can say how the robot stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attempt {
    /// The robot answers: whether it is on its dock, and charged, is asked.
    First,
    /// An earlier attempt, which began on the dock, left a robot that may be silent.
    Again,
}

/// A chip whose firmware is part of updates.
pub trait Chip {
    /// Looks whether the file (Intel HEX) is an image for this chip and whether the chip can be reached. Nothing is changed.
    ///
    /// # Errors
    /// Why it cannot be written.
    fn check(&mut self, hex: &[u8]) -> Result<(), ChipError>;

    /// Hash of what was verified in it last, whoever wrote it.
    fn verified(&self) -> Option<String>;

    /// Keeps what is in it, and gives its name for [`Chip::restore`]; none if the chip cannot be read and nothing is known of it.
    ///
    /// # Errors
    /// When it cannot be kept.
    fn keep(&mut self) -> Result<Option<String>, ChipError>;

    /// Writes and verifies an image. A calibration in the chip stays.
    ///
    /// # Errors
    /// Why it is not in the chip.
    fn write(&mut self, hex: &[u8], attempt: Attempt) -> Result<(), ChipError>;

    /// Writes and verifies what was kept.
    ///
    /// # Errors
    /// Why it is not in the chip.
    fn restore(&mut self, name: &str) -> Result<(), ChipError>;
}
