//! An update of the robot's software: how far it is, or how it ended.

use alloc::string::String;
use serde::{Deserialize, Serialize};

/// No file of an update is longer.
pub const UPDATE_BYTES_MAX: u64 = 256 << 20;

/// A step of an update, in the order in which they are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UpdateStage {
    /// The file comes over the network.
    Receive,
    /// It waits for the program that installs it.
    HandOver,
    /// Signature, hashes, robot, room on the disk.
    Verify,
    /// Its files are put into their folder.
    Unpack,
    /// Its programs start and must answer.
    TryPrograms,
    /// What is in the robot's chip is kept.
    KeepFirmware,
    /// The chip is written and read back.
    WriteFirmware,
    /// The robot must answer.
    TryFirmware,
    /// What was there before is put back.
    GoBack,
}

/// How an update ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UpdateEnd {
    /// It is in use.
    Installed,
    /// Nothing was changed.
    Refused,
    /// Everything is as it was before.
    WentBack,
    /// It did not work, and without a way back it is in use.
    WentOn,
    /// It did not work, and going back did not, either.
    NotSettled,
    /// Whoever installed it has ended in the midst.
    CutOff,
    /// It was in use until its daemon had failed too often.
    GivenUp,
}

/// The last update, or the one that goes on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SoftwareUpdate {
    /// The step that goes on, or the last one that began.
    pub stage: UpdateStage,
    /// Bytes of the file that came, while they come.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u64>,
    /// Length of the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub total: Option<u64>,
    /// Its epoch, once it is verified.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub epoch: Option<u64>,
    /// Its version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// Whether it writes the robot's chip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flashes: Option<bool>,
    /// How it ended; none while it goes on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<UpdateEnd>,
    /// The step that failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<UpdateStage>,
    /// Why, as a code.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Why, as a sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
}

impl SoftwareUpdate {
    /// One that is at this step.
    #[must_use]
    pub const fn at(stage: UpdateStage) -> Self {
        Self {
            stage,
            bytes: None,
            total: None,
            epoch: None,
            version: None,
            flashes: None,
            end: None,
            failed: None,
            reason: None,
            text: None,
        }
    }

    /// The same, ended for this reason.
    #[must_use]
    pub fn ended(mut self, end: UpdateEnd, reason: &str, text: &str) -> Self {
        self.failed.get_or_insert(self.stage);
        self.end = Some(end);
        self.reason = Some(reason.into());
        self.text = Some(text.into());
        self
    }
}
