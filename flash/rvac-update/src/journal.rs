//! What is installed, and what is about to be.

use std::io;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::disk::Disk;
use crate::error::UpdateError;
use crate::slots::{Programs, Slot, Slots};

/// The last update that was found to work.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Installed {
    /// Its epoch: none below it, nor the same, is accepted. 0 before the first.
    pub epoch: u64,
    /// Its version.
    pub version: String,
    /// The firmware that it brought.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub firmware: Option<InstalledFirmware>,
    /// What ran before it, as long as that can be started.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub before: Option<Programs>,
    /// Its daemon failed too often, so that what ran before runs again.
    #[serde(default, skip_serializing_if = "is_no")]
    pub given_up: bool,
}

/// Firmware that an update has written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InstalledFirmware {
    /// SHA-256 of the file in the update.
    pub file_sha256: String,
    /// What the journal of `rvac flash` said afterwards: when it says something else, somebody has written since.
    pub verified: String,
}

/// An update that is not known to work yet.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pending {
    /// Its epoch.
    pub epoch: u64,
    /// Its version.
    pub version: String,
    /// Where its programs are.
    pub slot: Slot,
    /// What ran before.
    pub before: Programs,
    /// Firmware as it will be, if it works.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub firmware: Option<InstalledFirmware>,
    /// How far it is.
    pub step: PendingStep,
}

/// How far an update is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum PendingStep {
    /// Its files are being put into their folder.
    Unpacking,
    /// Its programs run, or are about to.
    Trying,
    /// The firmware is being written.
    Flashing {
        /// The file, below the folder of its programs.
        path: String,
        /// What was in the chip, if that is known.
        kept: Option<String>,
    },
}

impl Slots {
    fn installed_path(&self) -> PathBuf {
        self.root().join("installed.toml")
    }

    fn pending_path(&self) -> PathBuf {
        self.root().join("pending.toml")
    }

    pub(crate) fn starts_path(&self) -> PathBuf {
        self.root().join("starts.toml")
    }

    /// The last update that works.
    ///
    /// # Errors
    /// When the file cannot be read or understood.
    pub fn installed(&self) -> Result<Installed, UpdateError> {
        read(self.installed_path()).map(Option::unwrap_or_default)
    }

    /// An update that was cut off, or runs now.
    ///
    /// # Errors
    /// When the file cannot be read or understood.
    pub fn pending(&self) -> Result<Option<Pending>, UpdateError> {
        read(self.pending_path())
    }

    pub(crate) fn note_installed(
        &self,
        disk: &mut impl Disk,
        installed: &Installed,
    ) -> Result<(), UpdateError> {
        write(disk, self.installed_path(), installed)
    }

    pub(crate) fn note_pending(&self, disk: &mut impl Disk, pending: &Pending) -> Result<(), UpdateError> {
        write(disk, self.pending_path(), pending)
    }

    pub(crate) fn forget_pending(&self, disk: &mut impl Disk) -> Result<(), UpdateError> {
        let path = self.pending_path();
        disk.remove(&path)
            .map_err(|error| UpdateError::File { path, error })
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
const fn is_no(value: &bool) -> bool {
    !*value
}

pub(crate) fn read<T: for<'a> Deserialize<'a>>(path: PathBuf) -> Result<Option<T>, UpdateError> {
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(UpdateError::File { path, error }),
    };
    match toml::from_str(&text) {
        Ok(value) => Ok(Some(value)),
        Err(error) => Err(UpdateError::Journal {
            path,
            error: error.to_string(),
        }),
    }
}

pub(crate) fn write(disk: &mut impl Disk, path: PathBuf, value: &impl Serialize) -> Result<(), UpdateError> {
    match toml::to_string(value) {
        Ok(text) => disk
            .replace(&path, text.as_bytes())
            .map_err(|error| UpdateError::File { path, error }),
        Err(error) => Err(UpdateError::Journal {
            path,
            error: error.to_string(),
        }),
    }
}
