//! What a device is and can do, as data.

use super::Shape;

/// What a device is and can do. Clients are generated from it; what is not in it does not exist.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Who it is.
    pub identity: Identity,
    /// Levels of control it offers.
    pub levels: &'static [Level],
    /// Body.
    pub shape: Shape,
    /// Width that one pass cleans, in metres.
    pub swath_m: f64,
    /// Wheels.
    pub drive: DriveLimits,
    /// What the totals of the wheels are worth.
    pub odometry: Odometry,
    /// Who reacts to what.
    pub reflexes: Reflexes,
    /// Who keeps the robot stopped after an emergency stop.
    pub stop: StopSite,
    /// How many sensors of each kind.
    pub sensors: SensorCounts,
    /// Optional parts that it has, in a fixed order.
    pub parts: Vec<Part>,
    /// Motors of which nothing notices that they are held fast: `wheels`, `brush-main`, `brush-sides`, `vacuum`.
    pub unguarded: Vec<&'static str>,
    /// Motors whose current is not measured though that of others is.
    pub unmeasured: Vec<&'static str>,
}

/// Who a device is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Identity {
    /// Model, for example `sr8730`.
    pub device: String,
    /// Version of its firmware.
    pub firmware: String,
    /// Version of its wire in use.
    pub protocol: u8,
}

/// A level of control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// We own wheels and motors.
    Motion,
    /// The robot owns navigation and takes tasks.
    Task,
}

/// What the wheels can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveLimits {
    /// Distance between the wheels' contact points in metres.
    pub track_m: f64,
    /// Highest forward speed in m/s.
    pub speed_max_m_per_s: f64,
    /// Highest turn rate in rad/s.
    pub turn_max_rad_per_s: f64,
    /// The device's own dead man.
    pub dead_man: DeadManKind,
}

/// How a device stops by itself when no command comes. Where it does not by time, the host also sees to it that a command
/// to stand that got lost is given again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeadManKind {
    /// Never: it keeps the last command for ever.
    None,
    /// After the commanded distance.
    Distance,
    /// After the time that each command carries.
    PerCommand,
}

/// What the totals of the wheels are worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Odometry {
    /// Way of the rim in metres by which a total changes at least.
    pub resolution_m: f64,
    /// Whether the totals are signed, forward positive. Where they do not the host takes the direction from its commands.
    pub sign_reliable: bool,
}

/// Who reacts to a contact, a cliff and lifting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflexes {
    /// Bumper.
    pub bump: ReflexSite,
    /// Cliff sensors.
    pub cliff: ReflexSite,
    /// Wheel drop.
    pub lift: ReflexSite,
}

/// Where a reflex lives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReflexSite {
    /// In the device, within milliseconds.
    Device,
    /// In the host, as soon as it is reported.
    Host {
        /// Longest time from what happens to the wheels' answer, seconds.
        latency_s: f64,
    },
    /// Nowhere: the device has no such sensor.
    Absent,
}

/// Who keeps a robot stopped after an emergency stop, until it is armed again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopSite {
    /// The device, which reports it.
    Device,
    /// The host.
    Host,
}

/// Numbers of sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SensorCounts {
    /// Bumper zones.
    pub bumpers: u8,
    /// Cliff sensors.
    pub cliffs: u8,
    /// Wheel drop switches.
    pub wheel_drops: u8,
    /// Proximity sensors.
    pub proximity: u8,
    /// Dock receivers.
    pub dock_receivers: u8,
    /// Buttons.
    pub buttons: u8,
    /// Lights.
    pub leds: u8,
}

/// A part that not every robot has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Gyro.
    Gyro,
    /// Main brush.
    BrushMain,
    /// Side brushes.
    BrushSides,
    /// Suction.
    Vacuum,
    /// Beeper.
    Beeper,
    /// Battery measurement.
    Battery,
    /// Measurement of motor currents.
    Currents,
    /// Charger under the firmware's control.
    Charger,
}

impl Part {
    /// The name that clients see.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gyro => "gyro",
            Self::BrushMain => "brush-main",
            Self::BrushSides => "brush-sides",
            Self::Vacuum => "vacuum",
            Self::Beeper => "beeper",
            Self::Battery => "battery",
            Self::Currents => "currents",
            Self::Charger => "charger",
        }
    }
}

impl Description {
    /// Whether it has `part`.
    #[must_use]
    pub fn has(&self, part: Part) -> bool {
        self.parts.contains(&part)
    }

    /// Whether there may be a dock for it: something of it measures a pack, charges it, or hears a dock. A robot on which nothing was measured
    /// yet may lack the charger and the receivers, but not the voltage of its pack.
    #[must_use]
    pub fn may_have_dock(&self) -> bool {
        self.has(Part::Battery) || self.has(Part::Charger) || self.sensors.dock_receivers > 0
    }

    /// Whether it offers `level`.
    #[must_use]
    pub fn offers(&self, level: Level) -> bool {
        self.levels.contains(&level)
    }
}
