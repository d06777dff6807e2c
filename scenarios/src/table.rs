//! A table of outcomes beside the one that is expected.

use std::path::PathBuf;

use crate::Watched;
use crate::watched::COLUMNS;

/// Characters for what a row is about.
const WIDTH: usize = 54;

/// A table in the making. A change of behaviour shows as a difference of the table: look at it, and when it is what you wanted write
/// the new one with `UPDATE_EXPECTED=1 cargo test -p scenarios`.
#[derive(Debug)]
pub struct Table {
    name: &'static str,
    text: String,
}

impl Table {
    /// An empty table that is kept as `expected/NAME.txt`.
    #[must_use]
    pub fn new(name: &'static str, head: &str) -> Self {
        Self {
            name,
            text: format!("{head}\n\n"),
        }
    }

    /// An empty table of watched households.
    #[must_use]
    pub fn of_outcomes(name: &'static str, head: &str) -> Self {
        Self::new(name, &format!("{head}\n\n{:<WIDTH$} {COLUMNS}", ""))
    }

    /// Adds a line.
    pub fn line(&mut self, line: &str) {
        self.text += line.trim_end();
        self.text += "\n";
    }

    /// Adds what came of a household.
    pub fn row(&mut self, what: &str, watched: &Watched) {
        self.line(&format!("{what:<WIDTH$} {}", watched.row()));
    }

    /// Compares it with the expected one.
    ///
    /// # Panics
    /// When they differ.
    pub fn compare(&self) {
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("expected/{}.txt", self.name));
        if std::env::var_os("UPDATE_EXPECTED").is_some() {
            std::fs::write(&path, &self.text).expect("the table can be written");
        }
        let expected = std::fs::read_to_string(&path).unwrap_or_default();
        assert_eq!(
            self.text, expected,
            "\nthe table differs; it is now:\n{}",
            self.text
        );
    }
}
