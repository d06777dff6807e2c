//! The eight digits that are shown to the person who opened the window.

use std::fmt;

const DIGITS: usize = 8;
const CODES: u64 = 100_000_000;

/// A code.
#[derive(Clone, PartialEq, Eq)]
pub struct Code(String);

/// What was typed is no code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("A code has eight digits.")]
pub struct CodeError;

impl Code {
    /// A code drawn from random bytes. The bias of the remainder is below one in 10^11.
    #[must_use]
    pub fn from_random(random: [u8; 8]) -> Self {
        Self(format!("{:08}", u64::from_le_bytes(random) % CODES))
    }

    /// Reads what a person typed; spaces and hyphens between the digits do not matter.
    ///
    /// # Errors
    /// When it has not eight digits.
    pub fn parse(text: &str) -> Result<Self, CodeError> {
        let digits: String = text.chars().filter(|c| !matches!(c, ' ' | '-')).collect();
        let fits = digits.len() == DIGITS && digits.bytes().all(|byte| byte.is_ascii_digit());
        fits.then_some(Self(digits)).ok_or(CodeError)
    }

    /// For people: two groups of four.
    #[must_use]
    pub fn shown(&self) -> String {
        let (first, second) = self.0.split_at(DIGITS / 2);
        format!("{first} {second}")
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        self.0.as_bytes()
    }
}

impl fmt::Debug for Code {
    /// Without the digits, which belong into no log.
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str("Code(..)")
    }
}

#[cfg(test)]
mod tests {
    use super::{Code, CodeError};

    #[test]
    fn what_is_shown_can_be_typed() {
        let code = Code::from_random([7, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(code.shown(), "0000 0007");
        assert_eq!(Code::parse(&code.shown()), Ok(code.clone()));
        assert_eq!(Code::parse("0000-0007"), Ok(code));
        for wrong in ["", "1234567", "123456789", "1234567a", "１２３４５６７８"] {
            assert_eq!(Code::parse(wrong), Err(CodeError), "{wrong}");
        }
    }
}
