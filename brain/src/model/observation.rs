//! What the robot perceived, in SI units and REP-103 axes, whatever the make of the robot.

/// One view of the robot at one moment. Totals, not rates, so that a lost observation loses nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Host time in microseconds since the daemon's start; rises strictly.
    pub time_us: u64,
    /// Way of the left wheel's rim since the device was attached, in metres, forward positive.
    pub travel_left_m: f64,
    /// Way of the right wheel's rim since the device was attached, in metres, forward positive.
    pub travel_right_m: f64,
    /// Unwrapped heading of the gyro in radians, if the robot has one.
    pub gyro_heading_rad: Option<f64>,
    /// Bumper zones that are pressed.
    pub contacts: Contacts,
    /// Cliff sensors that see no floor.
    pub cliffs: Cliffs,
    /// A wheel hangs.
    pub wheel_drop: bool,
    /// Proximity from the right side counter-clockwise, 0..1 (1 = touching); empty if the robot has none.
    pub proximity: Vec<f32>,
    /// Symbols heard by the dock receivers (0 = none); empty if the robot has none.
    pub dock_beams: Vec<u8>,
    /// What a radio has measured of beacons since the last observation; empty where there is no radio.
    pub beacons: Vec<BeaconSignal>,
    /// On the dock's contacts.
    pub docked: bool,
    /// Battery charge 0..1, if measured.
    pub battery_charge: Option<f32>,
    /// What the charger says; `None` where the firmware controls none or has not measured yet.
    pub charge_flow: Option<ChargeFlow>,
    /// What the motors draw; `None` where the robot does not measure it.
    pub currents: Option<MotorCurrents>,
    /// Names of what keeps the firmware from moving, for example `wheel-drop`; empty when it may move.
    pub inhibits: Vec<&'static str>,
    /// The link to the firmware is up and its telemetry is fresh.
    pub link_up: bool,
    /// Share of the commanded speed that link quality allows, 0..1.
    pub speed_share: f64,
}

impl Observation {
    /// A bumper is pressed, or the firmware still holds the wheels because of one.
    #[must_use]
    pub fn is_touching(&self) -> bool {
        self.contacts.any() || self.inhibits.contains(&"bumper")
    }

    /// A cliff is seen, or the firmware still holds the wheels because of one.
    #[must_use]
    pub fn is_at_cliff(&self) -> bool {
        self.cliffs.any() || self.inhibits.contains(&"cliff")
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
            docked: false,
            battery_charge: None,
            charge_flow: None,
            currents: None,
            inhibits: Vec::new(),
            link_up: true,
            speed_share: 1.0,
        }
    }
}

/// What the motors draw, in amperes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotorCurrents {
    /// Of the left wheel.
    pub wheel_left_a: f32,
    /// Of the right wheel.
    pub wheel_right_a: f32,
    /// Of the main brush.
    pub brush_main_a: f32,
}

/// What flows from the dock into the pack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChargeFlow {
    /// Current flows.
    Flowing,
    /// None flows, and that has a reason: the pack is full, too warm or too cold, or the charger names a fault.
    Withheld,
    /// None flows, though the pack needs it and could take it.
    Missing,
}

/// What a radio has measured of a beacon. A strength is no distance: walls, bodies and the way an antenna points change it by as
/// much as walking half or twice as far does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BeaconSignal {
    /// How far it is.
    Range(BeaconRange),
    /// How strongly it is received.
    Strength(BeaconStrength),
}

/// Strength with which a radio beacon is received.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeaconStrength {
    /// Number of the beacon, the same as long as the daemon runs.
    pub beacon: u16,
    /// Received power, decibels above a milliwatt.
    pub dbm: f64,
}

/// Distance to a radio beacon, measured by time of flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeaconRange {
    /// Number of the beacon, the same as long as the daemon runs.
    pub beacon: u16,
    /// Measured distance, metres.
    pub range_m: f64,
    /// Standard deviation that the one who measured gives to it with nothing in the way, metres.
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
    /// Whether any sensor sees no floor.
    #[must_use]
    pub fn any(self) -> bool {
        self.left || self.middle || self.right
    }
}
