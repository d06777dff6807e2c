//! What was written last, and whether it was finished: a write that was cut off is remembered.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

/// How far a write came.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WriteState {
    /// It has begun.
    Writing,
    /// It is in the chip and verified.
    Verified,
}

/// The last write.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JournalEntry {
    /// How far it came.
    pub state: WriteState,
    /// SHA-256 of what is, or should be, in the chip.
    pub sha256: String,
    /// When, UTC.
    pub date: String,
    /// SHA-256 of the last image that was verified: for a chip that cannot be read, the way back.
    pub last_verified: Option<String>,
}

/// The last write of a calibration, which touches one page and leaves the firmware.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CalibrationEntry {
    state: WriteState,
    /// When, UTC.
    date: String,
}

/// The journal of one robot.
#[derive(Clone, Debug)]
pub struct Journal {
    path: PathBuf,
    calibration: PathBuf,
}

impl Journal {
    /// The journal in this folder.
    pub fn new(folder: &Path) -> Self {
        Self {
            path: folder.join("last-write.toml"),
            calibration: folder.join("last-calibration.toml"),
        }
    }

    /// The last write; none when there was none, or when the file says nothing that is understood.
    pub fn last(&self) -> Option<JournalEntry> {
        let text = kept_file::read_text(&self.path).ok()?;
        toml::from_str(&text).ok()
    }

    /// A write begins.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn begin(&self, sha256: &str, date: &str) -> std::io::Result<()> {
        let last_verified = self.last().and_then(|last| last.last_verified);
        let entry = JournalEntry {
            state: WriteState::Writing,
            sha256: sha256.to_owned(),
            date: date.to_owned(),
            last_verified,
        };
        put(&self.path, &entry)
    }

    /// It is verified.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn verified(&self, sha256: &str, date: &str) -> std::io::Result<()> {
        let entry = JournalEntry {
            state: WriteState::Verified,
            sha256: sha256.to_owned(),
            date: date.to_owned(),
            last_verified: Some(sha256.to_owned()),
        };
        put(&self.path, &entry)
    }

    /// A calibration begins to be written, or is verified.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn calibration(&self, state: WriteState, date: &str) -> std::io::Result<()> {
        let date = date.to_owned();
        put(&self.calibration, &CalibrationEntry { state, date })
    }

    /// When the last write of a calibration began, if it was cut off: its page may hold anything.
    pub fn calibration_cut_off(&self) -> Option<String> {
        let text = kept_file::read_text(&self.calibration).ok()?;
        let last: CalibrationEntry = toml::from_str(&text).ok()?;
        (last.state == WriteState::Writing).then_some(last.date)
    }

    /// A sentence about a write that was cut off, if the last one was.
    pub fn warning(&self) -> Option<String> {
        let firmware = self.last().filter(|last| last.state == WriteState::Writing);
        let firmware = firmware.map(|last| {
            format!(
                "The write of {} was cut off: the robot runs nothing until it is written again or restored.",
                last.date
            )
        });
        firmware.or_else(|| {
            let date = self.calibration_cut_off()?;
            Some(format!(
                "The calibration of {date} was cut off: the robot does not drive until `rvac flash calibration` is run again."
            ))
        })
    }
}

fn put(path: &Path, entry: &impl Serialize) -> std::io::Result<()> {
    let text = toml::to_string(entry).map_err(std::io::Error::other)?;
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    kept_file::replace(path, text.as_bytes())
}
