//! Identity of the robot: handshake and description.

use heapless::String;
use rvac_units::{AngularSpeed, Length, Speed, Tick};

/// A short name: device, firmware version.
pub type Name = String<24>;

/// A version of the protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ProtocolVersion(pub u8);

impl ProtocolVersion {
    /// Oldest version this crate speaks. Never raised: any two versions can exchange `hello`, `info`, `log` and `stop`.
    pub const MIN: Self = Self(1);
    /// Newest version this crate speaks. Raise it when a packet changes its meaning; new packets and new optional keys
    /// need no new version.
    pub const CURRENT: Self = Self(1);
}

/// Packet kinds that have a binary form, as a set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct BinaryKinds {
    /// Telemetry, robot to host.
    pub state: bool,
    /// Drive, host to robot.
    pub drive: bool,
}

impl BinaryKinds {
    /// No kind.
    pub const NONE: Self = Self {
        state: false,
        drive: false,
    };
    /// Every kind of this version.
    pub const ALL: Self = Self {
        state: true,
        drive: true,
    };

    /// The kinds both sides know.
    #[must_use]
    pub const fn common(self, other: Self) -> Self {
        Self {
            state: self.state && other.state,
            drive: self.drive && other.drive,
        }
    }
}

/// Why the microcontroller started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ResetCause {
    /// Power came on.
    PowerOn,
    /// Supply voltage fell too low.
    BrownOut,
    /// The watchdog was not fed.
    Watchdog,
    /// Reset pin.
    External,
    /// The firmware asked for it (panic handler, update).
    Software,
    /// The chip does not report it.
    Unknown,
}

impl ResetCause {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::PowerOn,
        Self::BrownOut,
        Self::Watchdog,
        Self::External,
        Self::Software,
        Self::Unknown,
    ];

    /// The name on the wire.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::PowerOn => "power-on",
            Self::BrownOut => "brown-out",
            Self::Watchdog => "watchdog",
            Self::External => "external",
            Self::Software => "software",
            Self::Unknown => "unknown",
        }
    }

    /// The cause with exactly this name.
    #[must_use]
    pub fn from_name(name: &[u8]) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|cause| cause.name().as_bytes() == name)
    }
}

/// Opening of a session by the robot; also sent without a request after a reset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotHello {
    /// Oldest version the robot speaks.
    pub version_min: ProtocolVersion,
    /// Newest version the robot speaks.
    pub version_max: ProtocolVersion,
    /// Device, for example `sr8730`.
    pub device: Name,
    /// Firmware version.
    pub firmware: Name,
    /// Session number for the CRC; 0 when no session is open.
    pub session: u16,
    /// Largest packet that the robot accepts, in bytes without the separator.
    pub packet_max: u16,
    /// Starts since the firmware was written, as far as the board counts them.
    pub boot_count: u32,
    /// Why it started.
    pub reset_cause: ResetCause,
    /// Binary kinds agreed for this session.
    pub binary: BinaryKinds,
    /// Present tick, so that the first motion command is fresh.
    pub tick: Tick,
}

/// Some of the motors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MotorSet {
    /// Both wheels.
    pub wheels: bool,
    /// Main brush.
    pub brush_main: bool,
    /// Side brushes.
    pub brush_sides: bool,
    /// Suction.
    pub vacuum: bool,
}

impl MotorSet {
    /// The motors with their names on the wire.
    #[must_use]
    pub const fn named(self) -> [(&'static str, bool); 4] {
        [
            ("wheels", self.wheels),
            ("brush-main", self.brush_main),
            ("brush-sides", self.brush_sides),
            ("vacuum", self.vacuum),
        ]
    }
}

/// What the robot does not know of its motors. A robot of an older version says nothing of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MotorGaps {
    /// Nothing notices that these are held fast (S11).
    pub unguarded: MotorSet,
    /// The current of these is not measured, though that of others is.
    pub unmeasured: MotorSet,
}

/// Parts of the board. An absent part is never simulated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Capabilities {
    /// Wheel encoders.
    pub encoders: bool,
    /// Gyro (heading and rate).
    pub gyro: bool,
    /// Number of bumper zones, 0..=2 (left, right).
    pub bumpers: u8,
    /// Number of cliff sensors, 0..=4.
    pub cliffs: u8,
    /// Number of wheel drop switches, 0..=2.
    pub wheel_drops: u8,
    /// Number of infrared proximity sensors, 0..=8.
    pub proximity: u8,
    /// Number of dock receivers, 0..=4.
    pub dock_receivers: u8,
    /// Number of buttons, 0..=8.
    pub buttons: u8,
    /// Number of lights, 0..=16.
    pub leds: u8,
    /// Sound.
    pub beeper: bool,
    /// Main brush.
    pub brush_main: bool,
    /// Side brushes.
    pub brush_sides: bool,
    /// Suction.
    pub vacuum: bool,
    /// Motor currents are measured.
    pub currents: bool,
    /// Battery voltage, current and temperature are measured.
    pub battery: bool,
    /// The firmware charges.
    pub charger: bool,
    /// Raw readings are available.
    pub probe: bool,
}

/// Geometry and limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Highest forward speed.
    pub speed_max: Speed,
    /// Highest turn rate.
    pub turn_max: AngularSpeed,
    /// Distance between the wheels' contact points.
    pub track: Length,
    /// Distance of the rim per encoder count, in nanometres.
    pub count_nm: u32,
    /// Radius of the body (0 if it is not round).
    pub radius: Length,
    /// Width that one pass cleans.
    pub swath: Length,
}

/// The robot's description, assembled from its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Description {
    /// The parts of the board.
    pub capabilities: Capabilities,
    /// Geometry and limits.
    pub limits: Limits,
    /// What it does not know of its motors.
    pub motors: MotorGaps,
}
