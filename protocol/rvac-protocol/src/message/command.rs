//! Commands from host to robot.

use rvac_units::{AngularSpeed, Frequency, Length, Ratio, Speed, Throttle, Tick};

use super::{BinaryKinds, CommandName, Inhibit, Probe, ProtocolVersion};

/// Rising number of a command, modulo 65,536.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sequence(pub u16);

impl Sequence {
    /// Whether `self` is newer than `other`: ahead by less than half the range, modulo the wrap.
    #[must_use]
    pub const fn is_newer_than(self, other: Self) -> bool {
        let ahead = self.0.wrapping_sub(other.0);
        ahead != 0 && ahead < 0x8000
    }

    /// The following number.
    #[must_use]
    pub const fn next(self) -> Self {
        Self(self.0.wrapping_add(1))
    }
}

/// A command from host to robot. The set is closed: an unknown command never becomes a `Command`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Opens a session.
    Hello(HostHello),
    /// Leaves checked mode: a person types.
    Hand,
    /// Asks for row `row` of the description table; the robot answers with one `describe` packet.
    Describe {
        /// Row, from 0.
        row: u8,
    },
    /// Asks for an `info` report.
    Info,
    /// Asks for one `state` report.
    State,
    /// Drives under a lease.
    Drive(Drive),
    /// Runs one motor under a lease.
    Motor(MotorCommand),
    /// Moves a bounded distance. Acknowledged.
    Move(Move),
    /// Stops everything, at once, in any form and any mode.
    Stop,
    /// Plays a tone.
    Beep(Beep),
    /// Sets a light.
    Led(Led),
    /// Allows motion after a reset or `stop`; also takes the robot off the dock when `undock`. Acknowledged.
    Arm {
        /// Number for the acknowledgement.
        sequence: Sequence,
        /// Whether motion off the dock is allowed (S19).
        undock: bool,
    },
    /// Clears a latched inhibit whose cause is gone. Acknowledged.
    Clear {
        /// Number for the acknowledgement.
        sequence: Sequence,
        /// The inhibit to clear.
        inhibit: Inhibit,
    },
    /// Sets a parameter. Acknowledged.
    Set {
        /// Number for the acknowledgement.
        sequence: Sequence,
        /// Which.
        parameter: Parameter,
        /// New value in the parameter's own unit.
        value: i32,
    },
    /// Asks only for an acknowledgement: keeps a session alive and measures the round trip. The session answers it; it
    /// never reaches the firmware.
    Ping {
        /// Number for the acknowledgement.
        sequence: Sequence,
    },
    /// Confirms every event up to and including this number. The session handles it; it never reaches the firmware.
    Seen {
        /// Number of the newest event without a gap before it.
        event: u16,
    },
    /// Requests a full charge now, or forbids charging until it is requested again. Acknowledged.
    Charge {
        /// Number for the acknowledgement.
        sequence: Sequence,
        /// Charge now, else not at all.
        wanted: bool,
    },
    /// Asks for raw readings. Acknowledged.
    Probe(Probe),
}

impl Command {
    /// The command's name on the wire.
    #[must_use]
    pub const fn name(&self) -> CommandName {
        match self {
            Self::Hello(_) => CommandName::Hello,
            Self::Hand => CommandName::Hand,
            Self::Describe { .. } => CommandName::Describe,
            Self::Info => CommandName::Info,
            Self::State => CommandName::State,
            Self::Drive(_) => CommandName::Drive,
            Self::Motor(_) => CommandName::Motor,
            Self::Move(_) => CommandName::Move,
            Self::Stop => CommandName::Stop,
            Self::Beep(_) => CommandName::Beep,
            Self::Led(_) => CommandName::Led,
            Self::Arm { .. } => CommandName::Arm,
            Self::Clear { .. } => CommandName::Clear,
            Self::Set { .. } => CommandName::Set,
            Self::Ping { .. } => CommandName::Ping,
            Self::Seen { .. } => CommandName::Seen,
            Self::Charge { .. } => CommandName::Charge,
            Self::Probe(_) => CommandName::Probe,
        }
    }

    /// The command's number, if it carries one.
    #[must_use]
    pub const fn sequence(&self) -> Option<Sequence> {
        match self {
            Self::Drive(drive) => Some(drive.sequence),
            Self::Motor(motor) => Some(motor.sequence),
            Self::Move(movement) => Some(movement.sequence),
            Self::Arm { sequence, .. }
            | Self::Clear { sequence, .. }
            | Self::Set { sequence, .. }
            | Self::Ping { sequence }
            | Self::Charge { sequence, .. } => Some(*sequence),
            Self::Probe(probe) => Some(probe.sequence),
            Self::Hello(_)
            | Self::Hand
            | Self::Describe { .. }
            | Self::Info
            | Self::State
            | Self::Stop
            | Self::Beep(_)
            | Self::Led(_)
            | Self::Seen { .. } => None,
        }
    }

    /// Whether the host repeats it until it is acknowledged.
    #[must_use]
    pub const fn must_arrive(&self) -> bool {
        matches!(
            self,
            Self::Move(_)
                | Self::Arm { .. }
                | Self::Clear { .. }
                | Self::Set { .. }
                | Self::Ping { .. }
                | Self::Charge { .. }
                | Self::Probe(_)
        )
    }
}

/// Opening of a session by the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostHello {
    /// Oldest version the host speaks.
    pub version_min: ProtocolVersion,
    /// Newest version the host speaks.
    pub version_max: ProtocolVersion,
    /// Binary kinds the host can read and write.
    pub binary: BinaryKinds,
}

/// Velocity of the robot's base under a lease.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Drive {
    /// Forward speed.
    pub speed: Speed,
    /// Turn rate, counter-clockwise positive.
    pub turn: AngularSpeed,
    /// Life of the command in ms, 1..=1000.
    pub lease_ms: u16,
    /// Number; motion that is not newer than the last is refused.
    pub sequence: Sequence,
    /// The newest robot tick that the host has received; motion with a tick older than 400 ms is refused. In hand mode
    /// both may be absent: then the codec fills `sequence` with 0 and this with the present tick, and the session
    /// limits speed and lease instead.
    pub seen_tick: Tick,
}

/// A motor of the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Motor {
    /// `wheel left`
    WheelLeft,
    /// `wheel right`
    WheelRight,
    /// `brush main`
    BrushMain,
    /// `brush sides`: both side brushes together.
    BrushSides,
    /// `brush left`
    BrushLeft,
    /// `brush right`
    BrushRight,
    /// `vacuum`
    Vacuum,
}

impl LedPattern {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Off, Self::On, Self::Blink];

    /// The name on the wire.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::On => "on",
            Self::Blink => "blink",
        }
    }

    /// The pattern with exactly this name.
    #[must_use]
    pub fn from_name(name: &[u8]) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|pattern| pattern.name().as_bytes() == name)
    }
}

impl Motor {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::WheelLeft,
        Self::WheelRight,
        Self::BrushMain,
        Self::BrushSides,
        Self::BrushLeft,
        Self::BrushRight,
        Self::Vacuum,
    ];

    /// The name on the wire, unchanged since 2016.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::WheelLeft => "wheel left",
            Self::WheelRight => "wheel right",
            Self::BrushMain => "brush main",
            Self::BrushSides => "brush sides",
            Self::BrushLeft => "brush left",
            Self::BrushRight => "brush right",
            Self::Vacuum => "vacuum",
        }
    }

    /// The motor with exactly this name.
    #[must_use]
    pub fn from_name(name: &[u8]) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|motor| motor.name().as_bytes() == name)
    }
}

/// Throttle of one motor under a lease.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MotorCommand {
    /// Which motor.
    pub motor: Motor,
    /// How much.
    pub throttle: Throttle,
    /// Life of the command in ms, 1..=1000.
    pub lease_ms: u16,
    /// As in [`Drive`].
    pub sequence: Sequence,
    /// As in [`Drive`].
    pub seen_tick: Tick,
}

/// A bounded movement: straight, an arc, or a turn on the spot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Move {
    /// Path length of the robot's centre, backwards negative. With `radius` 0 it is the angle of a turn on the spot, in
    /// radians times one metre (1.57 m is a quarter turn to the left).
    pub length: Length,
    /// Signed radius of the arc, left positive; `None` goes straight.
    pub radius: Option<Length>,
    /// Number for the acknowledgement; also orders it among other motion.
    pub sequence: Sequence,
    /// As in [`Drive`].
    pub seen_tick: Tick,
}

/// A tone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Beep {
    /// Pitch, 20..=20,000 Hz; 0 is a pause.
    pub pitch: Frequency,
    /// Length in ms, 1..=10,000.
    pub duration_ms: u16,
    /// Loudness.
    pub volume: Ratio,
}

/// What a light does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LedPattern {
    /// Off.
    Off,
    /// Steady.
    On,
    /// 1 Hz.
    Blink,
}

/// Setting of one light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Led {
    /// Light by number, 0..=15; the description names them.
    pub led: u8,
    /// What it does.
    pub pattern: LedPattern,
    /// Brightness when on.
    pub brightness: Ratio,
}

/// A setting of the firmware.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// `state-ms`: pause between telemetry reports in ms, 0 = none, else 10..=10,000.
    StatePeriod,
    /// `info-ms`: pause between info reports in ms, 0 = none, else 100..=60,000.
    InfoPeriod,
}

impl Parameter {
    /// All of them, in the order of their rows in the description.
    pub const ALL: [Self; 2] = [Self::StatePeriod, Self::InfoPeriod];

    /// The name on the wire.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::StatePeriod => "state-ms",
            Self::InfoPeriod => "info-ms",
        }
    }

    /// The parameter with exactly this name.
    #[must_use]
    pub fn from_name(name: &[u8]) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|parameter| parameter.name().as_bytes() == name)
    }

    /// Smallest and largest value besides 0, which is always allowed.
    #[must_use]
    pub const fn range(self) -> (i32, i32) {
        match self {
            Self::StatePeriod => (10, 10_000),
            Self::InfoPeriod => (100, 60_000),
        }
    }
}
