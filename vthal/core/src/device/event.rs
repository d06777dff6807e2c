//! Events of a device.

use rvac_api::LogLevel;

use super::{Description, Report, SlowFacts};

/// An event of a device.
#[derive(Clone, Debug, PartialEq)]
pub enum DeviceEvent {
    /// The robot has opened a session; the description follows.
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
    /// The session with the robot has ended.
    Closed,
    /// The robot supports no version of the wire protocol that we do.
    Incompatible {
        /// Its oldest version.
        version_min: u8,
        /// Its newest version.
        version_max: u8,
    },
}

/// The identity of the robot, and whether it has restarted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Greeting {
    /// Model.
    pub device: String,
    /// Version of its firmware.
    pub firmware: String,
    /// Why it last started, if it reports that.
    pub reset_cause: Option<&'static str>,
    /// Whether it has restarted since its last report: its counters start again too.
    pub was_reset: bool,
}
