//! Why a calibration, or one step of it, does not go on.

use std::io;

use calibration_values::ValuesError;

use crate::arithmetic::NoValue;
use crate::thermistor::NoAgreement;

/// See the module.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// The person ends it; no fault.
    #[error("ended; what was kept is in the file")]
    Quit,
    /// The values, or their file.
    #[error(transparent)]
    Values(#[from] ValuesError),
    /// The robot does not answer at all.
    #[error(
        "the robot does not answer the handshake: check power, cable, --port and --baud, and that vthal does not run"
    )]
    NoHandshake,
    /// It was reset or lost power.
    #[error("the robot has left the session: it was reset or lost power")]
    SessionLost,
    /// The link ended.
    #[error("the serial line is gone: {0}")]
    LinkLost(io::Error),
    /// Bytes could not be sent.
    #[error("cannot write to the serial line: {0}")]
    LinkBroken(io::Error),
    /// Nobody can answer or hear any more.
    #[error("both input and serial line have ended")]
    NobodyLeft,
    /// A command was not answered.
    #[error("the robot did not answer {0}")]
    Unanswered(&'static str),
    /// Too much at once.
    #[error("eight commands wait for their answers")]
    Busy,
    /// The robot's firmware does not know a command.
    #[error("{0} cannot be sent to this robot")]
    Unsendable(&'static str),
    /// The robot says no.
    #[error("the robot refuses {what}: {why}")]
    Refused {
        /// What it was asked.
        what: &'static str,
        /// Its reason, with what inhibits it.
        why: String,
    },
    /// A reading was promised.
    #[error("the robot promised a raw reading and sent none")]
    NoReading,
    /// None came while motors ran.
    #[error("no reading came while the motors ran")]
    NoReadingDriven,
    /// A reading of something else.
    #[error("the robot answered with something else")]
    OtherReading,
    /// An older firmware.
    #[error("this firmware does not tell the pulses of the brush")]
    NoBrushPulses,
    /// One value is reckoned from another.
    #[error("{0} must be measured first")]
    Needed(String),
    /// The button was let go, or never pressed.
    #[error("no button was pressed to the end: hold it from before you press Enter until a value comes")]
    NotPressed,
    /// Its light is switched by the firmware.
    #[error(
        "this robot already knows its cliff sensors and switches their light itself; to measure again, program it without a \
         calibration"
    )]
    CliffsKnown,
    /// Motors stand at a high duty.
    #[error("nothing turns at {0} permille: are motors and encoders plugged in?")]
    NothingTurns(i32),
    /// Nobody held the button, or it was let go too early.
    #[error("the button was not held to the end, so the motors were stopped")]
    LetGo,
    /// Outside of its range.
    #[error("{shown} cannot be true: it lies in {low} to {high}")]
    Implausible {
        /// The value as people read it.
        shown: String,
        /// Least.
        low: i64,
        /// Greatest.
        high: i64,
    },
    /// The readings give no value.
    #[error(transparent)]
    NoValue(#[from] NoValue),
    /// A third temperature proves nothing.
    #[error(transparent)]
    NoAgreement(#[from] NoAgreement),
    /// What is shown cannot be shown.
    #[error("the terminal cannot be written: {0}")]
    Screen(#[from] io::Error),
}

impl CalibrationError {
    /// Its name for clients, which have their own words for it.
    #[must_use]
    pub const fn reason(&self) -> &'static str {
        match self {
            Self::Quit => "calibration-ended",
            Self::Values(error) => error.reason(),
            Self::NoHandshake
            | Self::SessionLost
            | Self::LinkLost(_)
            | Self::LinkBroken(_)
            | Self::NobodyLeft
            | Self::Unanswered(_)
            | Self::Busy
            | Self::NoReading
            | Self::NoReadingDriven
            | Self::OtherReading => "calibration-no-answer",
            Self::Unsendable(_) | Self::NoBrushPulses => "calibration-old-firmware",
            Self::Refused { .. } => "calibration-refused",
            Self::Needed(_) => "calibration-needed-first",
            Self::NotPressed => "calibration-not-pressed",
            Self::CliffsKnown => "calibration-cliffs-known",
            Self::NothingTurns(_) => "calibration-nothing-turns",
            Self::LetGo => "calibration-let-go",
            Self::Implausible { .. } => "calibration-implausible",
            Self::NoValue(no_value) => no_value.reason(),
            Self::NoAgreement(_) => "calibration-no-agreement",
            Self::Screen(_) => "calibration-ended",
        }
    }

    /// Whether the same step may be tried again at once; without the robot or the person nothing can.
    #[must_use]
    pub(crate) const fn is_of_step(&self) -> bool {
        !matches!(
            self,
            Self::Quit
                | Self::SessionLost
                | Self::LinkLost(_)
                | Self::LinkBroken(_)
                | Self::NobodyLeft
                | Self::Screen(_)
        )
    }
}
