//! What a device tells.

use rvac_api::LogLevel;

use super::{Description, Report, SlowFacts};

/// What a device told.
#[derive(Clone, Debug, PartialEq)]
pub enum DeviceEvent {
    /// The robot speaks with us; the description follows.
    Opened(Greeting),
    /// The robot has described itself.
    Described(Box<Description>),
    /// Telemetry.
    Report(Report),
    /// What changes slowly.
    Slow(SlowFacts),
    /// A button went down or up.
    Button {
        /// Number.
        button: u8,
        /// Down, else up.
        pressed: bool,
    },
    /// The robot switched this motor off for its load.
    MotorStopped(&'static str),
    /// The contacts of the dock closed or opened.
    Docked(bool),
    /// A line for people.
    Log {
        /// How grave.
        level: LogLevel,
        /// What.
        text: String,
    },
    /// A command was refused.
    Refused {
        /// Its number, if the robot could read it.
        number: Option<u32>,
        /// Why.
        reason: &'static str,
    },
    /// The command with this number was not answered.
    Unanswered(u32),
    /// So many events were lost.
    EventsLost(u32),
    /// The robot has taken the control back, for this reason. It is asked for again when it is needed.
    ControlLost(&'static str),
    /// The robot does not speak with us any more.
    Closed,
    /// The robot speaks no version of the wire that we do.
    Incompatible {
        /// Its oldest version.
        version_min: u8,
        /// Its newest version.
        version_max: u8,
    },
}

/// Who speaks, and whether it has started anew.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Greeting {
    /// Model.
    pub device: String,
    /// Version of its firmware.
    pub firmware: String,
    /// Why it last started, if it tells.
    pub reset_cause: Option<&'static str>,
    /// Whether it has started anew since it was last heard: what it counts begins anew too.
    pub was_reset: bool,
}
