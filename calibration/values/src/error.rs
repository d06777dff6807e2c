//! Why values cannot be used or kept.

use std::io;
use std::path::PathBuf;

/// See the module.
#[derive(Debug, thiserror::Error)]
pub enum ValuesError {
    /// There are no tables of this robot.
    #[error("nothing can be calibrated on a robot {robot:?}; known: {known}")]
    UnknownRobot {
        /// Its name.
        robot: String,
        /// Those that there are tables of.
        known: String,
    },
    /// There is no value of this name.
    #[error("there is no value {name:?}; known: {known}")]
    UnknownValue {
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// A table of the robot.
    #[error("{0}: {1}")]
    Table(&'static str, toml::de::Error),
    /// A signal that no pin of the converter reads.
    #[error("the pinout gives {0:?} no channel of the converter")]
    NoChannel(String),
    /// The file of values cannot be read.
    #[error("cannot read {0}: {1}")]
    Unreadable(PathBuf, io::Error),
    /// It cannot be written.
    #[error("cannot write {0}: {1}")]
    Unwritable(PathBuf, io::Error),
    /// It holds something else.
    #[error("{0} is not a calibration: it holds `robot = \"NAME\"` and a table [values] of whole numbers: {why}", why = .1.message())]
    NotCalibration(PathBuf, toml::de::Error),
    /// It is of another robot.
    #[error("{file} is of a robot {of:?}, not {robot:?}: name another file")]
    OtherRobot {
        /// The file.
        file: PathBuf,
        /// Whose it is.
        of: String,
        /// The robot that is there.
        robot: String,
    },
    /// It holds a value that is not known.
    #[error("{0} cannot be kept as it is: {1}")]
    Strange(PathBuf, Box<ValuesError>),
    /// It holds nothing.
    #[error("{0} holds no value: measure with `rvac calibrate`, or in the panel under Device")]
    Empty(PathBuf),
    /// A value that cannot be true.
    #[error("{name} is {value} {unit}, but can only lie in {low} to {high}")]
    OutOfRange {
        /// Its name.
        name: String,
        /// The value.
        value: i64,
        /// Unit of all three.
        unit: String,
        /// Least.
        low: i64,
        /// Greatest.
        high: i64,
    },
    /// More values than a record has room for.
    #[error("{0} values do not fit into a record")]
    TooMany(usize),
}

impl ValuesError {
    /// Its name for clients, which have their own words for it.
    #[must_use]
    pub const fn reason(&self) -> &'static str {
        match self {
            Self::UnknownRobot { .. } | Self::Table(..) | Self::NoChannel(_) | Self::TooMany(_) => {
                "calibration-unknown-robot"
            }
            Self::UnknownValue { .. } => "calibration-unknown-value",
            Self::Unreadable(..)
            | Self::NotCalibration(..)
            | Self::OtherRobot { .. }
            | Self::Strange(..)
            | Self::Empty(_)
            | Self::OutOfRange { .. } => "calibration-file-strange",
            Self::Unwritable(..) => "calibration-file-unwritable",
        }
    }
}
