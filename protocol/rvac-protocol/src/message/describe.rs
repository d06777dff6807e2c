//! The description table: what a robot understands and has, row by row.

use super::{Capabilities, Limits, MotorGaps, Parameter};

/// The name of a command, for tables and for the list of commands that a robot understands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum CommandName {
    /// `hello`
    Hello = 0,
    /// `hand`
    Hand = 1,
    /// `describe`
    Describe = 2,
    /// `info`
    Info = 3,
    /// `state`
    State = 4,
    /// `drive`
    Drive = 5,
    /// `motor`
    Motor = 6,
    /// `move`
    Move = 7,
    /// `stop`
    Stop = 8,
    /// `beep`
    Beep = 9,
    /// `led`
    Led = 10,
    /// `arm`
    Arm = 11,
    /// `clear`
    Clear = 12,
    /// `set`
    Set = 13,
    /// `ping`
    Ping = 14,
    /// `seen`
    Seen = 15,
    /// `charge`
    Charge = 16,
    /// `probe`
    Probe = 17,
}

impl CommandName {
    /// All of them, in the order of their bits.
    pub const ALL: [Self; 18] = [
        Self::Hello,
        Self::Hand,
        Self::Describe,
        Self::Info,
        Self::State,
        Self::Drive,
        Self::Motor,
        Self::Move,
        Self::Stop,
        Self::Beep,
        Self::Led,
        Self::Arm,
        Self::Clear,
        Self::Set,
        Self::Ping,
        Self::Seen,
        Self::Charge,
        Self::Probe,
    ];

    /// The name on the wire.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hello => "hello",
            Self::Hand => "hand",
            Self::Describe => "describe",
            Self::Info => "info",
            Self::State => "state",
            Self::Drive => "drive",
            Self::Motor => "motor",
            Self::Move => "move",
            Self::Stop => "stop",
            Self::Beep => "beep",
            Self::Led => "led",
            Self::Arm => "arm",
            Self::Clear => "clear",
            Self::Set => "set",
            Self::Ping => "ping",
            Self::Seen => "seen",
            Self::Charge => "charge",
            Self::Probe => "probe",
        }
    }

    /// The command with exactly this name.
    #[must_use]
    pub fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"hello" => Self::Hello,
            b"hand" => Self::Hand,
            b"describe" => Self::Describe,
            b"info" => Self::Info,
            b"state" => Self::State,
            b"drive" => Self::Drive,
            b"motor" => Self::Motor,
            b"move" => Self::Move,
            b"stop" => Self::Stop,
            b"beep" => Self::Beep,
            b"led" => Self::Led,
            b"arm" => Self::Arm,
            b"clear" => Self::Clear,
            b"set" => Self::Set,
            b"ping" => Self::Ping,
            b"seen" => Self::Seen,
            b"charge" => Self::Charge,
            b"probe" => Self::Probe,
            _ => return None,
        })
    }
}

/// A set of command names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct CommandNames(u32);

impl CommandNames {
    /// No command.
    pub const NONE: Self = Self(0);
    /// Every command of this version.
    pub const ALL: Self = Self((1 << CommandName::ALL.len()) - 1);

    /// Whether `name` is in the set.
    #[must_use]
    pub const fn contains(self, name: CommandName) -> bool {
        self.0 & (1 << name as u32) != 0
    }

    /// Adds `name`.
    pub const fn insert(&mut self, name: CommandName) {
        self.0 |= 1 << name as u32;
    }
}

/// One row of the description table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DescribeRow {
    /// Which row this is, from 0.
    pub row: u8,
    /// How many rows there are.
    pub rows: u8,
    /// Its content.
    pub content: RowContent,
}

/// Content of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowContent {
    /// Geometry and limits.
    Limits(Limits),
    /// What the board has.
    Capabilities(Capabilities),
    /// The commands the robot understands.
    Commands(CommandNames),
    /// A parameter that can be set, with its range (0 is allowed besides and switches off).
    Parameter {
        /// Which.
        parameter: Parameter,
        /// Smallest value but 0.
        min: i32,
        /// Largest value.
        max: i32,
    },
    /// What the robot does not know of its motors.
    Motors(MotorGaps),
    /// A row of a newer robot that this version does not know.
    Unknown,
}
