//! Commands to a device, and why one is refused.

use rvac_units::Throttle;

use brain::Inhibit;

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
    /// Plays a tone.
    Tone(Tone),
    /// Sets a light.
    Light(Light),
}

/// A tone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tone {
    /// Hertz; 0 is a pause.
    pub pitch_hz: u32,
    /// Milliseconds.
    pub duration_ms: u16,
}

/// What a light does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Light {
    /// Number of the light.
    pub number: u8,
    /// What it does.
    pub pattern: LightPattern,
}

/// How a light shines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightPattern {
    /// Off.
    Off,
    /// Steady.
    On,
    /// Once a second.
    Blink,
}

/// What brushes and suction do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CleanerDrive {
    /// They are off.
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
    /// The robot cannot take it yet: it changes its mode, or has not answered the commands before.
    #[error("the robot has not answered the commands before")]
    Busy,
    /// The robot offers no control of its wheels and motors.
    #[error("the robot lets nobody drive it")]
    NotOffered,
    /// A reflex of the host stops the motors.
    #[error("held for what the sensors say")]
    Held,
    /// What an expert typed is no command of the robot.
    #[error("this is no command of the robot")]
    Syntax,
}
