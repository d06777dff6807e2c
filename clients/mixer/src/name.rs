//! Names that people give to profiles, lines, switches and inputs of clients.

use core::fmt;

use rvac_api::is_mix_name;
use serde::{Deserialize, Serialize};

/// A name: 1 to 32 letters, digits, blanks, `-` and `_`, with something other than a blank at both ends. It can be a file
/// name on every system.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Name(String);

/// Why a text is no name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no name: take 1 to 32 letters, digits, blanks, - and _, and no blank at the ends")]
pub struct NameError(pub String);

impl Name {
    /// The name with this text.
    ///
    /// # Errors
    /// [`NameError`] when it is none.
    pub fn new(text: &str) -> Result<Self, NameError> {
        if is_mix_name(text) {
            Ok(Self(text.to_owned()))
        } else {
            Err(NameError(text.to_owned()))
        }
    }

    /// A name of ours, which fits: a test reads every one.
    pub(crate) fn ours(text: &'static str) -> Self {
        Self(text.to_owned())
    }

    /// Its text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl TryFrom<String> for Name {
    type Error = NameError;

    fn try_from(text: String) -> Result<Self, NameError> {
        Self::new(&text)
    }
}

impl From<Name> for String {
    fn from(name: Name) -> Self {
        name.0
    }
}

impl fmt::Display for Name {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::Name;

    #[test]
    fn names_are_safe_as_file_names() {
        for good in ["a", "Anna's".trim_end_matches("'s"), "Köök 2", "left-hand_1"] {
            assert!(Name::new(good).is_ok(), "{good}");
        }
        for bad in [
            "",
            " a",
            "a ",
            "a/b",
            "..",
            "a.json",
            "a\n",
            "\"",
            &"x".repeat(33),
        ] {
            assert!(Name::new(bad).is_err(), "{bad}");
        }
    }
}
