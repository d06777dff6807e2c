//! Why an update is not in use.

use std::path::PathBuf;

use rvac_api::UpdateEnd;
use update_bundle::{BundleError, KeyError};

use crate::board::BoardError;
use crate::chip::ChipError;

/// Why an update is not in use. Unless it says otherwise, everything is as it was before.
#[derive(Debug, thiserror::Error)]
pub enum UpdateError {
    /// The file.
    #[error("refused: {0}")]
    Bundle(#[from] BundleError),
    /// Who may sign.
    #[error("refused: {0}")]
    Keys(#[from] KeyError),
    /// It is older than what is there, or the same.
    #[error("refused: its epoch is {offered}, and {installed} is installed: only a higher one is accepted")]
    OldEpoch {
        /// What is installed.
        installed: u64,
        /// Of the update.
        offered: u64,
    },
    /// It is for another robot.
    #[error("refused: it is for the robot {offered:?}, and this one is {here:?}")]
    OtherRobot {
        /// This one.
        here: String,
        /// Of the update.
        offered: String,
    },
    /// Which robot this is could not be found out.
    #[error(
        "refused: no robot answers the daemon, and no wiring file says which one this is: write /etc/rvac-flash.toml"
    )]
    RobotUnknown,
    /// It is for another board.
    #[error("refused: its programs are for {offered}, and this board is {here}")]
    OtherMachine {
        /// This one.
        here: String,
        /// Of the update.
        offered: String,
    },
    /// The robot is at work.
    #[error("refused: the robot is at work: stop it, and send it to its dock")]
    RobotWorks,
    /// Its firmware cannot be written here.
    #[error(
        "refused: it brings firmware, and nothing says how this board is wired to the chip. --without-firmware takes the programs alone"
    )]
    NoWiring,
    /// What is in the chip would be lost.
    #[error(
        "refused: this chip cannot be read, and no image of ours is known to run on this robot. If you can do without a way back, say so \
         with --i-have-no-way-back"
    )]
    NoWayBack,
    /// It does not fit.
    #[error("refused: it needs {needed_bytes} bytes on the disk, and {free_bytes} are free")]
    DiskFull {
        /// With some space left for others.
        needed_bytes: u64,
        /// What is free.
        free_bytes: u64,
    },
    /// The chip, before anything was touched.
    #[error("refused: {0}")]
    Chip(#[from] ChipError),
    /// A file of ours.
    #[error("{}: {error}", .path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        #[source]
        error: std::io::Error,
    },
    /// A note of ours is not understood.
    #[error("{}: {error}", .path.display())]
    Journal {
        /// Which.
        path: PathBuf,
        /// Why.
        error: String,
    },
    /// Programs were not started.
    #[error("{0}")]
    Board(#[from] BoardError),
    /// It did not work, and everything is as it was before.
    #[error("it did not work, and everything is as it was before: {0}")]
    WentBack(Box<UpdateError>),
    /// It did not work, and there was no way back.
    #[error("without a way back the update was finished once more, but: {0}")]
    WentOn(Box<UpdateError>),
    /// It did not work, and going back did not, either.
    #[error(
        "it did not work ({cause}), and going back is not finished: {error}. `rvac update --settle` tries again"
    )]
    NotSettled {
        /// Why it did not work.
        cause: Box<UpdateError>,
        /// Why going back did not.
        error: Box<UpdateError>,
    },
    /// Something does not answer.
    #[error("{0} does not answer with the update")]
    Silent(&'static str),
}

impl UpdateError {
    /// The same as a code, for programs and for other languages.
    #[must_use]
    pub fn reason(&self) -> &str {
        match self {
            Self::Bundle(error) => reason_of_bundle(error),
            Self::Keys(_) => "update-no-key",
            Self::OldEpoch { .. } => "update-old",
            Self::OtherRobot { .. } => "update-other-robot",
            Self::RobotUnknown => "update-robot-unknown",
            Self::OtherMachine { .. } => "update-other-board",
            Self::RobotWorks => "robot-moves",
            Self::NoWiring => "update-no-wiring",
            Self::NoWayBack => "update-no-way-back",
            Self::DiskFull { .. } => "update-disk-full",
            Self::Chip(ChipError::NotNow(failure)) => &failure.reason,
            Self::Chip(_) => "update-chip",
            Self::File { .. } | Self::Journal { .. } => "update-file",
            Self::Board(_) => "update-restart",
            Self::WentBack(cause) | Self::WentOn(cause) | Self::NotSettled { cause, .. } => cause.reason(),
            Self::Silent(_) => "update-silent",
        }
    }

    /// What was wrong, without what became of the update.
    #[must_use]
    pub fn cause(&self) -> String {
        match self {
            Self::WentBack(cause) | Self::WentOn(cause) | Self::NotSettled { cause, .. } => cause.cause(),
            other => {
                let text = other.to_string();
                text.strip_prefix("refused: ").map_or(text.clone(), str::to_owned)
            }
        }
    }

    /// What the update came to.
    #[must_use]
    pub const fn end(&self) -> UpdateEnd {
        match self {
            Self::WentBack(_) => UpdateEnd::WentBack,
            Self::WentOn(_) => UpdateEnd::WentOn,
            Self::NotSettled { .. } => UpdateEnd::NotSettled,
            _ => UpdateEnd::Refused,
        }
    }
}

const fn reason_of_bundle(error: &BundleError) -> &'static str {
    match error {
        BundleError::CutOff { .. } => "update-cut-off",
        BundleError::NotABundle { .. } => "no-update",
        BundleError::UnknownKey => "update-unknown-key",
        BundleError::WrongSignature | BundleError::SignatureFormat => "update-wrong-signature",
        BundleError::Unreadable(_) | BundleError::Kept { .. } => "update-file",
        _ => "update-damaged",
    }
}
