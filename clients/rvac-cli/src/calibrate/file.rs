//! What was measured: a file of the owner's, one line a value. No line of it is lost.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use serde::Deserialize;

use super::catalog::Catalog;

/// The file, and what it holds.
#[derive(Debug)]
pub(crate) struct Measurements {
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
    pub(crate) fn open(path: &Path, catalog: &Catalog) -> anyhow::Result<Self> {
        let mut measurements = Self {
            path: path.to_owned(),
            values: BTreeMap::new(),
        };
        let text = match kept_file::read_text(path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(measurements),
            Err(error) => return Err(error).with_context(|| format!("cannot read {}", path.display())),
        };
        let content: Content = toml::from_str(&text).with_context(|| {
            format!(
                "{} is not a calibration: it holds `robot = \"NAME\"` and a table [values]",
                path.display()
            )
        })?;
        if content.robot != catalog.robot {
            bail!(
                "{} is of a robot {:?}, not {:?}: name another file with --file",
                path.display(),
                content.robot,
                catalog.robot
            );
        }
        for (name, value) in content.values {
            let item = catalog
                .find(&name)
                .with_context(|| format!("{} cannot be kept as it is", path.display()))?;
            measurements.values.insert(item.name.clone(), value);
        }
        Ok(measurements)
    }

    /// A value, if it was measured.
    pub(crate) fn get(&self, name: &str) -> Option<i64> {
        self.values.get(name).copied()
    }

    /// Keeps a value: the file is written beside the old one and then takes its place.
    pub(crate) fn keep(&mut self, catalog: &Catalog, name: &str, value: i64) -> anyhow::Result<()> {
        self.values.insert(name.to_owned(), value);
        let beside = self.path.with_extension("toml.new");
        std::fs::write(&beside, self.text(catalog))
            .and_then(|()| std::fs::rename(&beside, &self.path))
            .with_context(|| format!("cannot write {}", self.path.display()))
    }

    fn text(&self, catalog: &Catalog) -> String {
        let mut text = format!(
            "# Measured on one robot by `rvac calibrate`; `cargo xtask firmware {0} --calibration FILE` builds it in.\n\
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

#[cfg(test)]
mod tests {
    use super::Measurements;
    use crate::calibrate::catalog::Catalog;
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
