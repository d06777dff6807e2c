//! Reports from robot to host.

use heapless::String;
use rvac_units::{Angle, AngularSpeed, Current, Ratio, Temperature, Tick, Voltage};

use super::{ArmingState, ChargerStatus, Inhibits, Motor, Name, Probed, RobotHello, Sequence};

/// Most proximity sensors a report can carry.
pub const PROXIMITY_SENSORS: usize = 8;

/// Text of a log report.
pub type LogText = String<120>;

/// A packet from robot to host.
#[derive(Clone, Debug, PartialEq)]
pub enum Report {
    /// Opening of a session.
    Hello(RobotHello),
    /// One row of the description table.
    Describe(super::DescribeRow),
    /// Slowly changing values.
    Info(Info),
    /// Telemetry.
    State(State),
    /// Something happened.
    Event(NumberedEvent),
    /// Answer to a numbered command.
    Acknowledgement(Acknowledgement),
    /// A requested raw reading.
    Probed(Probed),
    /// A line of text for people.
    Log {
        /// Severity.
        level: LogLevel,
        /// The text.
        text: LogText,
    },
}

/// Slowly changing values, under the keys of 2016.
#[derive(Clone, Debug, PartialEq)]
pub struct Info {
    /// `firmware-version`
    pub firmware_version: Name,
    /// `cordlib-version`
    pub cordlib_version: Name,
    /// `main-steps`: passes of the main loop in the last second.
    pub main_steps_hz: u32,
    /// Battery, if measured: `battery-status`, `-voltage`, `-current`, `-temperature`.
    pub battery: Option<Battery>,
    /// `bandwidth-in`: bytes received in the last second.
    pub bandwidth_in: u32,
    /// `bandwidth-out`: bytes sent in the last second.
    pub bandwidth_out: u32,
    /// Link counters since reset.
    pub link: LinkCounters,
    /// `arming`: who may move the robot; firmware before this key does not tell.
    pub arming: Option<ArmingState>,
}

/// Quality of the link as the robot sees it, totals since its reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkCounters {
    /// Packets accepted.
    pub accepted: u32,
    /// Packets whose CRC was wrong.
    pub bad_crc: u32,
    /// Bytes lost in the receiver.
    pub overrun: u32,
    /// Bytes with a wrong stop bit.
    pub framing: u32,
    /// Packets longer than the limit, or with a forbidden control byte.
    pub malformed: u32,
    /// Packets with the right CRC that were refused.
    pub refused: u32,
    /// Poisoned packets, after which the receiver waited for the next separator.
    pub resync: u32,
}

/// Battery readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Battery {
    /// Charge, 0..1 (`battery-status`).
    pub charge: Ratio,
    /// Pack voltage.
    pub voltage: Voltage,
    /// Into the pack is positive.
    pub current: Current,
    /// Pack temperature; `None` when it cannot be measured.
    pub temperature: Option<Temperature>,
    /// State of the charger.
    pub state: ChargeState,
    /// Details of the charger, if the firmware controls it.
    pub charger: Option<ChargerStatus>,
}

/// State of the charger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ChargeState {
    /// Not on the dock.
    #[default]
    Discharging,
    /// On the dock, current flows in.
    Charging,
    /// On the dock, full.
    Full,
    /// On the dock, not charging because of a fault.
    Fault,
}

/// Bumper switches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Bumpers {
    /// Left half pressed.
    pub left: bool,
    /// Right half pressed.
    pub right: bool,
}

/// Cliff sensors; true = no floor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Cliffs {
    /// Left sensor.
    pub left: bool,
    /// Middle sensor.
    pub middle: bool,
    /// Right sensor.
    pub right: bool,
}

/// Wheel drop switches; true = the wheel hangs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct WheelDrops {
    /// Left wheel.
    pub left: bool,
    /// Right wheel.
    pub right: bool,
}

/// Gyro readings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gyro {
    /// Integrated heading since reset; the sum wraps through the whole `i32` range.
    pub heading: Angle,
    /// Present rate.
    pub rate: AngularSpeed,
}

/// Motor currents.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Currents {
    /// Left wheel.
    pub wheel_left: Current,
    /// Right wheel.
    pub wheel_right: Current,
    /// Main brush.
    pub brush_main: Current,
}

/// Last symbol of each dock receiver, 0 = none: left, right, rear left, rear right.
pub type DockReceivers = [u8; 4];

/// State of motion control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MotionPhase {
    /// Nothing.
    #[default]
    Idle,
    /// A `drive` lease runs.
    Drive,
    /// A `move` runs.
    Move,
    /// A wheel is driven by `motor`.
    Motor,
    /// A reflex brakes.
    Reflex,
}

/// Telemetry. Totals, not rates, so that a lost report loses nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// When it was taken.
    pub tick: Tick,
    /// Left encoder total, wraps through `i32`. Forward positive.
    pub count_left: i32,
    /// Right encoder total, wraps through `i32`. Forward positive.
    pub count_right: i32,
    /// Gyro, if there is one.
    pub gyro: Option<Gyro>,
    /// Bumpers.
    pub bumpers: Bumpers,
    /// Cliffs.
    pub cliffs: Cliffs,
    /// Wheel drops.
    pub wheel_drops: WheelDrops,
    /// Proximity by sensor from the right side counter-clockwise, 0 = nothing, 255 = touching.
    pub proximity: [u8; PROXIMITY_SENSORS],
    /// Dock receivers.
    pub dock: DockReceivers,
    /// Buttons that are down, bit by number.
    pub buttons: u8,
    /// Dust box inserted; `None` without a switch behind it.
    pub dust_box: Option<bool>,
    /// Motor currents; `None` while they are not measured.
    pub currents: Option<Currents>,
    /// Voltage and current of the pack; `None` while they are not measured.
    pub pack: Option<PackReading>,
    /// State of the charger.
    pub charge: ChargeState,
    /// On the dock contacts.
    pub docked: bool,
    /// Everything that inhibits motion.
    pub inhibits: Inhibits,
    /// State of motion control.
    pub motion: MotionPhase,
    /// Cleaning motors that run now: bit 0 main brush, 1 side brushes, 2 vacuum.
    pub cleaners: u8,
}

/// Voltage and current of the pack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PackReading {
    /// At its terminals.
    pub voltage: Voltage,
    /// Into the pack is positive.
    pub current: Current,
}

/// How a `move` ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MoveEnd {
    /// The whole distance was covered.
    Done,
    /// Something inhibits.
    Inhibited,
    /// A newer motion command took over.
    Replaced,
    /// It took too long.
    TimedOut,
}

/// Something happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A bumper changed: the new state of both.
    Bump(Bumpers),
    /// A cliff sensor changed: the new state of all.
    Cliff(Cliffs),
    /// A wheel drop changed: the new state of both.
    Lift(WheelDrops),
    /// A button went down or up.
    Button {
        /// By number.
        button: u8,
        /// Down, else up.
        pressed: bool,
    },
    /// The dock contacts closed or opened.
    Docked(bool),
    /// A `move` ended.
    MoveFinished(MoveEnd),
    /// The set of inhibits changed: the new set.
    Inhibits(Inhibits),
    /// A motor was switched off for its load (S11).
    Stall(Motor),
}

/// A numbered event. The robot repeats unconfirmed events, the host drops duplicates and detects gaps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NumberedEvent {
    /// Rising number.
    pub number: u16,
    /// When it happened.
    pub tick: Tick,
    /// The event.
    pub kind: Event,
}

/// Why a command was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Refusal {
    /// A number is out of range.
    Range,
    /// A required key is missing.
    Missing,
    /// A key occurs twice.
    Duplicate,
    /// A motion command has a key it must not have.
    UnknownKey,
    /// The command or a name in it is not known.
    Unknown,
    /// The CRC is missing in checked mode.
    NoCrc,
    /// Not newer than the last motion command.
    Old,
    /// The host's view of the robot is older than 400 ms.
    Stale,
    /// An inhibit forbids it; `state` shows which.
    Inhibited,
    /// The board has no such part.
    Absent,
    /// Queue full.
    Busy,
    /// The cause of the latched inhibit is still there.
    CauseRemains,
    /// Not JSON according to the specification.
    Syntax,
}

impl Refusal {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::Range,
        Self::Missing,
        Self::Duplicate,
        Self::UnknownKey,
        Self::Unknown,
        Self::NoCrc,
        Self::Old,
        Self::Stale,
        Self::Inhibited,
        Self::Absent,
        Self::Busy,
        Self::CauseRemains,
        Self::Syntax,
    ];

    /// The name on the wire.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Range => "range",
            Self::Missing => "missing",
            Self::Duplicate => "duplicate",
            Self::UnknownKey => "key",
            Self::Unknown => "unknown",
            Self::NoCrc => "unsealed",
            Self::Old => "old",
            Self::Stale => "stale",
            Self::Inhibited => "inhibited",
            Self::Absent => "absent",
            Self::Busy => "busy",
            Self::CauseRemains => "cause-remains",
            Self::Syntax => "syntax",
        }
    }

    /// The reason with exactly this name.
    #[must_use]
    pub fn from_name(name: &[u8]) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|refusal| refusal.name().as_bytes() == name)
    }
}

/// Answer to a numbered command: executed, or refused with a named reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Acknowledgement {
    /// The command's number; `None` answers a refused command whose number could not be read.
    pub sequence: Option<Sequence>,
    /// `None` = executed.
    pub refusal: Option<Refusal>,
}

/// Severity of a log line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LogLevel {
    /// For developers.
    Debug,
    /// Worth knowing.
    Info,
    /// A fault that does not stop work.
    Warn,
    /// A fault that stops work.
    Error,
}
