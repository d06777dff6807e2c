//! How far an update is, for those who ask later: a file that outlives the programs that are started again.

use std::path::{Path, PathBuf};

use rvac_api::{SoftwareUpdate, UpdateEnd, UpdateStage};

use crate::disk::Disk as _;
use crate::disk::RealDisk;
use crate::error::UpdateError;
use crate::journal::Installed;
use crate::updater::{Settled, UpdateStep};

/// Its name in the folder of updates. Who reads it finds that nobody holds the lock when it was left behind.
const NAME: &str = "progress.json";

/// The file and what it says.
#[derive(Debug)]
pub(crate) struct ProgressFile {
    path: PathBuf,
    told: SoftwareUpdate,
}

impl ProgressFile {
    /// Of an update that begins now.
    pub(crate) fn begin(folder: &Path) -> Self {
        Self {
            path: folder.join(NAME),
            told: SoftwareUpdate::at(UpdateStage::Verify),
        }
    }

    /// Of one that was cut off.
    pub(crate) fn resume(folder: &Path) -> Self {
        let path = folder.join(NAME);
        let text = std::fs::read(&path).unwrap_or_default();
        let told = serde_json::from_slice(&text).unwrap_or(SoftwareUpdate::at(UpdateStage::GoBack));
        Self { path, told }
    }

    pub(crate) fn on_step(&mut self, step: &UpdateStep) {
        let told = &mut self.told;
        let stage = match step {
            UpdateStep::Verify => UpdateStage::Verify,
            UpdateStep::Verified {
                epoch,
                version,
                flashes,
            } => {
                told.epoch = Some(*epoch);
                told.version = Some(version.clone());
                told.flashes = Some(*flashes);
                UpdateStage::Verify
            }
            UpdateStep::Unpack => UpdateStage::Unpack,
            UpdateStep::TryPrograms => UpdateStage::TryPrograms,
            UpdateStep::KeepFirmware => UpdateStage::KeepFirmware,
            UpdateStep::WriteFirmware => UpdateStage::WriteFirmware,
            UpdateStep::TryFirmware => UpdateStage::TryFirmware,
            UpdateStep::GoBack => UpdateStage::GoBack,
        };
        if stage == UpdateStage::GoBack && told.stage != UpdateStage::GoBack {
            told.failed = Some(told.stage);
        }
        told.stage = stage;
        told.end = None;
        self.keep();
    }

    /// It is in use.
    pub(crate) fn installed(&mut self) {
        self.told.end = Some(UpdateEnd::Installed);
        self.keep();
    }

    /// It is not.
    pub(crate) fn failed(&mut self, error: &anyhow::Error) {
        match error.downcast_ref::<UpdateError>() {
            Some(error) => self.end(error.end(), error.reason(), &error.cause()),
            None => self.end(UpdateEnd::Refused, "update-file", &format!("{error:#}")),
        }
    }

    /// One that was cut off has come to an end.
    pub(crate) fn settled(&mut self, settled: Settled) {
        match settled {
            Settled::Nothing => {}
            Settled::WentBack => self.end(
                UpdateEnd::WentBack,
                "update-interrupted",
                "it was cut off, and everything is as it was before",
            ),
            Settled::WentOn => self.installed(),
        }
    }

    fn end(&mut self, end: UpdateEnd, reason: &str, text: &str) {
        self.told = self.told.clone().ended(end, reason, &sentence(text));
        self.keep();
    }

    /// What cannot be told stops no update.
    fn keep(&self) {
        if let Ok(bytes) = serde_json::to_vec(&self.told) {
            RealDisk.replace(&self.path, &bytes).ok();
        }
    }
}

/// What is the end of a line for programs, as a sentence for people.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    let mut told: String = first.chain(letters).collect();
    if !told.ends_with('.') {
        told.push('.');
    }
    told
}

/// An update was in use and is not any more.
pub(crate) fn tell_given_up(folder: &Path, installed: &Installed) {
    let mut progress = ProgressFile {
        path: folder.join(NAME),
        told: SoftwareUpdate {
            epoch: Some(installed.epoch),
            version: Some(installed.version.clone()),
            ..SoftwareUpdate::at(UpdateStage::TryPrograms)
        },
    };
    let text = "its daemon failed three times one after the other; the programs before it run again";
    progress.end(UpdateEnd::GivenUp, "update-daemon-fails", text);
}
