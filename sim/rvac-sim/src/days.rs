//! Figures of runs that follow each other, as `bench-life` keeps them for a page.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::trace::{keep_as, kept_in};

/// Ending of the files that hold them.
const ENDING: &str = ".days.json";

/// Medians and 90th percentiles of each run of some chains.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct KeptDays {
    /// What they are of.
    pub title: String,
    /// For each run its number under `run`, and each figure with its `median` and `p90`.
    pub days: Vec<Value>,
}

impl KeptDays {
    /// Writes them into a folder, which is made if need be; those of the same title are written over.
    ///
    /// # Errors
    /// When the folder or the file cannot be written.
    pub fn keep(&self, folder: &Path) -> anyhow::Result<PathBuf> {
        keep_as(folder, (&self.title, ENDING), self)
    }

    /// All of a folder, by name.
    ///
    /// # Errors
    /// When the folder cannot be read, or a file is not what it seems.
    pub fn all(folder: &Path) -> anyhow::Result<Vec<Self>> {
        kept_in(folder, ENDING)
    }

    /// Run and value of a figure, for all runs that have it. `which` is `median` or `p90`.
    pub(crate) fn curve(&self, figure: &str, which: &str) -> Vec<(f64, f64)> {
        let days = self.days.iter();
        days.filter_map(|day| Some((day["run"].as_f64()?, day[figure][which].as_f64()?)))
            .collect()
    }
}
