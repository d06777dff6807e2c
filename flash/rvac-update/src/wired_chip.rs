//! The chip that this board is wired to.

use rvac_flash::{LoanError, RobotAnswers, WiredError, WiredRobot};

use crate::chip::{Attempt, Chip, ChipError};

/// The robot of a wiring file.
#[derive(Debug)]
pub(crate) struct WiredChip(pub(crate) WiredRobot);

impl Chip for WiredChip {
    fn check(&mut self, hex: &[u8]) -> Result<(), ChipError> {
        self.0.check(text_of(hex)?).map_err(|error| match error {
            WiredError::Hex(_) | WiredError::Image(_) => ChipError::Image(error.to_string()),
            WiredError::Loan(LoanError::Refused(failure)) => ChipError::NotNow(failure),
            _ => ChipError::Unreachable(error.to_string()),
        })
    }

    fn verified(&self) -> Option<String> {
        self.0.verified()
    }

    fn keep(&mut self) -> Result<Option<String>, ChipError> {
        self.0
            .keep()
            .map_err(|error| ChipError::NotKept(error.to_string()))
    }

    fn write(&mut self, hex: &[u8], attempt: Attempt) -> Result<(), ChipError> {
        let answers = match attempt {
            Attempt::First => RobotAnswers::Expected,
            Attempt::Again => RobotAnswers::Silent,
        };
        self.0
            .write(text_of(hex)?, answers)
            .map_err(|error| ChipError::NotWritten(error.to_string()))
    }

    fn restore(&mut self, name: &str) -> Result<(), ChipError> {
        self.0
            .restore(name)
            .map_err(|error| ChipError::NotWritten(error.to_string()))
    }
}

fn text_of(hex: &[u8]) -> Result<&str, ChipError> {
    std::str::from_utf8(hex).map_err(|_| ChipError::Image("it is no text".to_owned()))
}
