//! What was measured: a file of the owner's, one line a value. No line of it is lost.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::catalog::Catalog;
use crate::error::ValuesError;

/// The file, and what it holds.
#[derive(Debug)]
pub struct Measurements {
    path: PathBuf,
    values: BTreeMap<String, i64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Content {
    robot: String,
    #[serde(default)]
    values: BTreeMap<String, i64>,
}

impl Measurements {
    /// Reads the file; one that is not there is empty.
    ///
    /// # Errors
    /// It cannot be read, or holds something else.
    pub fn open(path: &Path, catalog: &Catalog) -> Result<Self, ValuesError> {
        match kept_file::read_text(path) {
            Ok(text) => Self::parse(path, &text, catalog),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(Self {
                path: path.to_owned(),
                values: BTreeMap::new(),
            }),
            Err(error) => Err(ValuesError::Unreadable(path.to_owned(), error)),
        }
    }

    /// The same of the file's text.
    ///
    /// # Errors
    /// It is something else.
    pub fn parse(path: &Path, text: &str, catalog: &Catalog) -> Result<Self, ValuesError> {
        let mut values = BTreeMap::new();
        let content: Content =
            toml::from_str(text).map_err(|error| ValuesError::NotCalibration(path.to_owned(), error))?;
        if content.robot != catalog.robot {
            return Err(ValuesError::OtherRobot {
                file: path.to_owned(),
                of: content.robot,
                robot: catalog.robot.clone(),
            });
        }
        for (name, value) in content.values {
            let item = catalog
                .find(&name)
                .map_err(|error| ValuesError::Strange(path.to_owned(), Box::new(error)))?;
            values.insert(item.name.clone(), value);
        }
        let path = path.to_owned();
        Ok(Self { path, values })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Number of values that were measured.
    #[must_use]
    pub fn count(&self) -> usize {
        self.values.len()
    }

    /// A value, if it was measured.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<i64> {
        self.values.get(name).copied()
    }

    /// Keeps a value: the file is written beside the old one, flushed, and then takes its place.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn keep(&mut self, catalog: &Catalog, name: &str, value: i64) -> Result<(), ValuesError> {
        self.values.insert(name.to_owned(), value);
        let beside = self.path.with_extension("toml.new");
        written(&beside, &self.text(catalog))
            .and_then(|()| fs::rename(&beside, &self.path))
            .map_err(|error| ValuesError::Unwritable(self.path.clone(), error))
    }

    /// The file as text.
    #[must_use]
    pub fn text(&self, catalog: &Catalog) -> String {
        let mut text = format!(
            "# Measured on one robot by `rvac calibrate`; `rvac flash calibration` writes it into the robot.\n\
             robot = \"{0}\"\n\n[values]\n",
            catalog.robot
        );
        for item in &catalog.items {
            if let Some(value) = self.values.get(&item.name) {
                // Writing to a string does not fail.
                writeln!(text, "{} = {value} # {}", item.name, item.unit).ok();
            }
        }
        text
    }
}

fn written(path: &Path, text: &str) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(text.as_bytes())?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use super::Measurements;
    use crate::catalog::Catalog;
    use crate::folder::Folder;

    #[test]
    fn values_come_back_and_a_strange_file_is_left_alone() {
        let folder = Folder::new();
        let path = folder.join("mine.toml");
        let catalog = Catalog::of("sr8730").expect("known");
        let mut measured = Measurements::open(&path, &catalog).expect("not there yet");
        measured.keep(&catalog, "wheel-track", 231_000).expect("kept");
        measured
            .keep(&catalog, "wheel-distance-per-count", 480_000)
            .expect("kept");
        let again = Measurements::open(&path, &catalog).expect("readable");
        assert_eq!(again.get("wheel-track"), Some(231_000));
        assert_eq!(again.get("battery-capacity"), None);
        for (text, wanted) in [
            (
                "robot = \"relax\"\n[values]\n",
                "of a robot \"relax\", not \"sr8730\"",
            ),
            (
                "robot = \"sr8730\"\n[values]\nwheel = 3\n",
                "cannot be kept as it is",
            ),
            ("[values]\n", "is not a calibration"),
        ] {
            std::fs::write(&path, text).expect("writable");
            let said = format!("{:#}", Measurements::open(&path, &catalog).expect_err(text));
            assert!(said.contains(wanted), "{said}");
            assert_eq!(std::fs::read_to_string(&path).expect("there"), text);
        }
    }
}
