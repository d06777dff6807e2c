//! The device model: one shape for robots of every make. Planner and clients see [`Description`], [`DeviceCommand`] and
//! [`CommandError`], never the words of a wire.
//!
//! A make of robot is one file beside `own_firmware.rs` that turns commands into its own bytes and its own reports
//! into events. What must hold for every make lives above the makes, in [`Device`]: a drive command that is not
//! renewed ends, whatever the robot itself does.

mod attached;
mod dead_man;
mod description;
mod own_firmware;

pub use attached::{Device, DeviceIo};
pub use own_firmware::FirmwareEvent;

pub use description::{
    DeadManKind, Description, DriveLimits, Identity, Level, Part, ReflexSite, Reflexes, SensorCounts, Shape,
};

use rvac_protocol::message::{Inhibit, LedPattern};
use rvac_units::Throttle;

/// A command to a device, in SI units and REP-103 axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DeviceCommand {
    /// Drives the base.
    Drive {
        /// Forward speed, m/s.
        speed_m_per_s: f64,
        /// Turn rate, rad/s, counter-clockwise positive.
        turn_rad_per_s: f64,
        /// Microseconds after which the wheels stop unless a newer command came.
        valid_for_us: u64,
    },
    /// Stands still under control, brakes held.
    Halt,
    /// Lets go of the wheels.
    Rest,
    /// Stops everything and latches: nothing moves until the next [`DeviceCommand::Arm`].
    EmergencyStop,
    /// Brushes and suction.
    Cleaners(CleanerDrive),
    /// Allows motion again.
    Arm {
        /// Whether leaving the dock is meant.
        leave_dock: LeaveDock,
    },
    /// Clears a latched inhibit.
    Clear(Inhibit),
    /// Plays a tone; pitch 0 is a pause.
    Tone {
        /// Hertz.
        pitch_hz: u32,
        /// Milliseconds.
        duration_ms: u16,
    },
    /// Sets light number `led`.
    Light {
        /// Number.
        led: u8,
        /// What it does.
        pattern: LedPattern,
    },
}

/// What brushes and suction do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CleanerDrive {
    /// They stand.
    Off,
    /// They run.
    On(CleanerPower),
}

/// How hard each of them runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CleanerPower {
    /// The main brush.
    pub brush_main: Throttle,
    /// The side brushes.
    pub brush_sides: Throttle,
    /// Suction.
    pub vacuum: Throttle,
}

impl CleanerPower {
    /// Nothing runs.
    pub const NONE: Self = Self {
        brush_main: Throttle::ZERO,
        brush_sides: Throttle::ZERO,
        vacuum: Throttle::ZERO,
    };
    /// As in a job.
    pub const FULL: Self = Self {
        brush_main: Throttle::FULL,
        brush_sides: Throttle::FULL,
        vacuum: Throttle::FULL,
    };
}

/// Whether motion off the dock is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeaveDock {
    /// No.
    Stay,
    /// Yes.
    Leave,
}

/// Why a command was not passed on. Nothing was sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CommandError {
    /// No session with the robot, or it has not described itself yet.
    #[error("no robot is attached")]
    NotAttached,
    /// A number is not finite or beyond the limits of the description.
    #[error("a number is out of range")]
    Range,
    /// The robot has no such part.
    #[error("the robot has no such part")]
    Absent,
    /// Stopped by [`DeviceCommand::EmergencyStop`].
    #[error("stopped until armed again")]
    Latched,
    /// Too many commands wait for an answer of the robot.
    #[error("the robot has not answered the commands before")]
    Busy,
}
