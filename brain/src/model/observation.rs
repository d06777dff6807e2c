//! What the robot perceives, in SI units and REP-103 axes, independent of its make.

use super::inhibit::{Inhibit, Inhibits};

/// Beacons that tell a heading in motion: with two a robot cannot tell its place from the mirrored one.
const BEACONS_MIN: u8 = 3;

/// The state of all sensors at one moment. It holds totals instead of rates, so a lost observation loses nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Host time in microseconds since the daemon's start; strictly increasing.
    pub time_us: u64,
    /// Distance travelled by the left wheel's rim since the device was attached, in metres, forward positive.
    pub travel_left_m: f64,
    /// Distance travelled by the right wheel's rim since the device was attached, in metres, forward positive.
    pub travel_right_m: f64,
    /// Unwrapped heading of the gyro in radians, if the robot has one.
    pub gyro_heading_rad: Option<f64>,
    /// Bumper zones that are pressed.
    pub contacts: Contacts,
    /// Cliff sensors that detect no floor.
    pub cliffs: Cliffs,
    /// A wheel has dropped.
    pub wheel_drop: bool,
    /// Proximity from the right side counter-clockwise, 0..1 (1 = touching); empty if the robot has none.
    pub proximity: Vec<f32>,
    /// Symbols at the dock receivers (0 = none); empty if the robot has none.
    pub dock_beams: Vec<u8>,
    /// Radio measurements of beacons since the last observation; empty without a radio.
    pub beacons: Vec<BeaconSignal>,
    /// Number of beacons whose distance was measured lately, also before this brain began.
    pub beacons_in_range: u8,
    /// On the dock's contacts.
    pub docked: bool,
    /// Battery charge 0..1, if measured.
    pub battery_charge: Option<f32>,
    /// State of the charging current; `None` where the firmware has no charger or no measurement yet.
    pub charge_flow: Option<ChargeFlow>,
    /// Motor currents; `None` where the robot does not measure them.
    pub currents: Option<MotorCurrents>,
    /// Reasons why the robot may not move; empty when it may.
    pub inhibits: Inhibits,
    /// The link to the firmware is up and its telemetry is fresh.
    pub link_up: bool,
    /// Share of the commanded speed that link quality allows, 0..1.
    pub speed_share: f64,
}

impl Observation {
    /// Whether enough beacons are in range to tell a robot that drives its heading.
    #[must_use]
    pub fn hears_beacons(&self) -> bool {
        self.beacons_in_range >= BEACONS_MIN
    }

    /// Whether a bumper is pressed, or the firmware still inhibits motion because of one.
    #[must_use]
    pub fn is_touching(&self) -> bool {
        self.contacts.any() || self.inhibits.contains(Inhibit::Bumper)
    }

    /// Whether a cliff is detected, or the firmware still inhibits motion because of one.
    #[must_use]
    pub fn is_at_cliff(&self) -> bool {
        self.cliffs.any() || self.inhibits.contains(Inhibit::Cliff)
    }
}

impl Default for Observation {
    /// A healthy robot on the floor, at rest, at time 0.
    fn default() -> Self {
        Self {
            time_us: 0,
            travel_left_m: 0.0,
            travel_right_m: 0.0,
            gyro_heading_rad: None,
            contacts: Contacts::default(),
            cliffs: Cliffs::default(),
            wheel_drop: false,
            proximity: Vec::new(),
            dock_beams: Vec::new(),
            beacons: Vec::new(),
            beacons_in_range: 0,
            docked: false,
            battery_charge: None,
            charge_flow: None,
            currents: None,
            inhibits: Inhibits::NONE,
            link_up: true,
            speed_share: 1.0,
        }
    }
}

/// Motor currents in amperes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotorCurrents {
    /// Of the left wheel.
    pub wheel_left_a: f32,
    /// Of the right wheel.
    pub wheel_right_a: f32,
    /// Of the main brush; `None` where only those of the wheels are measured.
    pub brush_main_a: Option<f32>,
}

/// State of the current from the dock into the pack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChargeFlow {
    /// Current flows.
    Flowing,
    /// No current for a good reason: the pack is full, too warm or too cold, or the charger reports a fault.
    Withheld,
    /// No current although the pack needs charge and could take it.
    Missing,
}

/// A radio measurement of a beacon. A strength is not a distance: walls, bodies and the orientation of an antenna change it as
/// much as half or twice the distance does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BeaconSignal {
    /// Distance to a beacon.
    Range(BeaconRange),
    /// Received signal strength of a beacon.
    Strength(BeaconStrength),
}

/// Received signal strength of a radio beacon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeaconStrength {
    /// Number of the beacon, the same in each run.
    pub beacon: u16,
    /// Received power, decibels above a milliwatt.
    pub dbm: f64,
}

/// Distance to a radio beacon, measured by time of flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeaconRange {
    /// Number of the beacon, the same in each run.
    pub beacon: u16,
    /// Measured distance, metres.
    pub range_m: f64,
    /// Standard deviation in line of sight, as reported by the radio, metres.
    pub sigma_m: f64,
}

/// Bumper zones. A robot with one zone reports both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Contacts {
    /// Left half pressed.
    pub left: bool,
    /// Right half pressed.
    pub right: bool,
}

/// Cliff sensors by side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cliffs {
    /// Left sensor.
    pub left: bool,
    /// Middle sensor.
    pub middle: bool,
    /// Right sensor.
    pub right: bool,
}

impl Contacts {
    /// Whether any zone is pressed.
    #[must_use]
    pub fn any(self) -> bool {
        self.left || self.right
    }
}

impl Cliffs {
    /// Whether any sensor detects no floor.
    #[must_use]
    pub fn any(self) -> bool {
        self.left || self.middle || self.right
    }
}
