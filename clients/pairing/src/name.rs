//! Names that people give their devices.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Characters of a name.
const LONGEST: usize = 40;

/// A name that can be shown anywhere: short, and without control characters.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct DeviceName(String);

/// Why a text is no name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NameError {
    /// Nothing is left of it.
    #[error("Give the device a name.")]
    Empty,
    /// Too long.
    #[error("A name has at most {LONGEST} characters.")]
    Long,
    /// It would disturb where it is shown.
    #[error("A name has no control characters.")]
    Control,
}

impl DeviceName {
    /// Takes a text, without spaces around it.
    ///
    /// # Errors
    /// See [`NameError`].
    pub fn new(text: &str) -> Result<Self, NameError> {
        let text = text.trim();
        if text.is_empty() {
            return Err(NameError::Empty);
        }
        if text.chars().count() > LONGEST {
            return Err(NameError::Long);
        }
        // The marks that turn the direction of text are as bad as control characters.
        let disturbs = |c: char| {
            c.is_control()
                || matches!(c, '\u{200e}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
        };
        if text.chars().any(disturbs) {
            return Err(NameError::Control);
        }
        Ok(Self(text.to_owned()))
    }

    /// The text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for DeviceName {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(&self.0)
    }
}

impl TryFrom<String> for DeviceName {
    type Error = NameError;

    fn try_from(text: String) -> Result<Self, NameError> {
        Self::new(&text)
    }
}

impl From<DeviceName> for String {
    fn from(name: DeviceName) -> Self {
        name.0
    }
}

#[cfg(test)]
mod tests {
    use super::{DeviceName, NameError};

    #[test]
    fn names() {
        assert_eq!(
            DeviceName::new(" Mari's phone ").unwrap().as_str(),
            "Mari's phone"
        );
        assert_eq!(DeviceName::new("  "), Err(NameError::Empty));
        assert_eq!(DeviceName::new(&"õ".repeat(41)), Err(NameError::Long));
        for bad in ["a\u{1b}[2J", "a\u{1f}b", "a\nb", "a\u{202e}b"] {
            assert_eq!(DeviceName::new(bad), Err(NameError::Control), "{bad:?}");
        }
    }
}
