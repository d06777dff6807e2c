//! The recorded forms of the brain's types, and the conversions both ways.
//!
//! Numbers are written so that reading them gives the same bits again; a replay rests on it.

mod answer;
mod flow;
mod order;
mod sensors;
mod state;

pub use answer::Answered;
pub use order::{GivenNoGo, GivenOrder, GivenPart, GivenPattern};
use order::{from_power, to_power};
pub use state::BrainState;

use brain::mapping::CutLine;
use brain::observation::{BeaconRange, Cliffs, Contacts};
use brain::{
    Body, BrainConfig, Command, KeptPlace, Observation, Point2, Pose2, RoomName, RoomSettings, Speeds,
    StrategyName,
};
use rvac_protocol::message::Inhibit;
use serde::{Deserialize, Serialize};
use vthal_core::RunStart;

use flow::FlowName;
use sensors::SensorSettings;

/// Version of these forms. Raised when an old recording cannot be replayed any more.
pub const FORMAT: u32 = 1;

/// Beginning of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RunHeader {
    /// [`FORMAT`] of the writer.
    pub format: u32,
    /// Version of the daemon.
    pub vthal: String,
    /// Host time in microseconds.
    pub time_us: u64,
    /// Number since the daemon's start.
    pub run: u32,
    /// Why it began.
    pub cause: String,
    /// Seed of the brain.
    pub seed: u64,
    /// Device.
    pub device: String,
    /// Version of its firmware.
    pub firmware: String,
    /// Settings of the brain.
    pub config: BrainSettings,
    /// What the brain took up.
    pub state: BrainState,
}

impl RunHeader {
    /// The header for a run of this daemon.
    #[must_use]
    pub fn new(start: &RunStart) -> Self {
        Self {
            format: FORMAT,
            vthal: env!("CARGO_PKG_VERSION").to_owned(),
            time_us: start.time_us,
            run: start.run,
            cause: start.cause.name().to_owned(),
            seed: start.seed,
            device: start.device.clone(),
            firmware: start.firmware.clone(),
            config: BrainSettings::from(&start.brain),
            state: BrainState::from(&start.checkpoint),
        }
    }
}

/// [`BrainConfig`]
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct BrainSettings {
    radius_m: f64,
    swath_m: f64,
    track_m: f64,
    cruise_m_per_s: f64,
    max_m_per_s: f64,
    turn_max_rad_per_s: f64,
    task_budget_s: f64,
    dock_budget_s: f64,
    battery_low: f32,
    /// Absent in recordings of earlier versions, whose brains did not go on by themselves.
    #[serde(default = "never")]
    battery_charged: f32,
    /// Absent in recordings of earlier versions.
    #[serde(default)]
    sensors: SensorSettings,
}

/// More charge than a pack can have.
fn never() -> f32 {
    2.0
}

impl From<&BrainConfig> for BrainSettings {
    fn from(config: &BrainConfig) -> Self {
        Self {
            radius_m: config.body.radius_m,
            swath_m: config.body.swath_m,
            track_m: config.body.track_m,
            cruise_m_per_s: config.speeds.cruise_m_per_s,
            max_m_per_s: config.speeds.max_m_per_s,
            turn_max_rad_per_s: config.speeds.turn_max_rad_per_s,
            task_budget_s: config.task_budget_s,
            dock_budget_s: config.dock_budget_s,
            battery_low: config.battery_low,
            battery_charged: config.battery_charged,
            sensors: SensorSettings::from(&config.sensors),
        }
    }
}

impl BrainSettings {
    /// Back to the brain's own type.
    #[must_use]
    pub fn to_brain(&self) -> BrainConfig {
        BrainConfig {
            body: Body {
                radius_m: self.radius_m,
                swath_m: self.swath_m,
                track_m: self.track_m,
            },
            speeds: Speeds {
                cruise_m_per_s: self.cruise_m_per_s,
                max_m_per_s: self.max_m_per_s,
                turn_max_rad_per_s: self.turn_max_rad_per_s,
            },
            task_budget_s: self.task_budget_s,
            dock_budget_s: self.dock_budget_s,
            battery_low: self.battery_low,
            battery_charged: self.battery_charged,
            sensors: self.sensors.to_brain(),
        }
    }
}

/// [`Observation`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    time_us: u64,
    left_m: f64,
    right_m: f64,
    gyro_rad: Option<f64>,
    /// Left, right.
    contacts: [bool; 2],
    /// Left, middle, right.
    cliffs: [bool; 3],
    wheel_drop: bool,
    proximity: Vec<f32>,
    dock_beams: Vec<u8>,
    docked: bool,
    battery: Option<f32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    charge_flow: Option<FlowName>,
    inhibits: Vec<String>,
    link_up: bool,
    speed_share: f64,
    /// Number, range and its deviation of each beacon that was measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    beacons: Vec<(u16, f64, f64)>,
}

impl From<&Observation> for Seen {
    fn from(seen: &Observation) -> Self {
        Self {
            time_us: seen.time_us,
            left_m: seen.travel_left_m,
            right_m: seen.travel_right_m,
            gyro_rad: seen.gyro_heading_rad,
            contacts: [seen.contacts.left, seen.contacts.right],
            cliffs: [seen.cliffs.left, seen.cliffs.middle, seen.cliffs.right],
            wheel_drop: seen.wheel_drop,
            proximity: seen.proximity.clone(),
            dock_beams: seen.dock_beams.clone(),
            docked: seen.docked,
            battery: seen.battery_charge,
            charge_flow: seen.charge_flow.map(FlowName::from),
            inhibits: seen.inhibits.iter().map(|&name| name.to_owned()).collect(),
            link_up: seen.link_up,
            speed_share: seen.speed_share,
            beacons: seen
                .beacon_ranges
                .iter()
                .map(|range| (range.beacon, range.range_m, range.sigma_m))
                .collect(),
        }
    }
}

impl Seen {
    /// Back to the brain's own type.
    #[must_use]
    pub fn to_brain(&self) -> Observation {
        let [left, right] = self.contacts;
        let [cliff_left, middle, cliff_right] = self.cliffs;
        Observation {
            time_us: self.time_us,
            travel_left_m: self.left_m,
            travel_right_m: self.right_m,
            gyro_heading_rad: self.gyro_rad,
            contacts: Contacts { left, right },
            cliffs: Cliffs {
                left: cliff_left,
                middle,
                right: cliff_right,
            },
            wheel_drop: self.wheel_drop,
            proximity: self.proximity.clone(),
            dock_beams: self.dock_beams.clone(),
            docked: self.docked,
            battery_charge: self.battery,
            charge_flow: self.charge_flow.map(FlowName::to_brain),
            inhibits: self.inhibits.iter().map(|name| inhibit_name(name)).collect(),
            link_up: self.link_up,
            speed_share: self.speed_share,
            beacon_ranges: self
                .beacons
                .iter()
                .map(|&(beacon, range_m, sigma_m)| BeaconRange {
                    beacon,
                    range_m,
                    sigma_m,
                })
                .collect(),
        }
    }
}

fn inhibit_name(name: &str) -> &'static str {
    Inhibit::from_name(name.as_bytes()).map_or(vthal_core::observe::UNKNOWN_INHIBIT, Inhibit::name)
}

/// [`Command`] with the time at which it was given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Given {
    /// Host time in microseconds.
    pub time_us: u64,
    /// What.
    pub command: GivenCommand,
}

/// [`Command`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GivenCommand {
    /// [`Command::Clean`] by the strategy's name.
    Clean(String),
    /// [`Command::CleanParts`]
    CleanParts(GivenOrder),
    /// [`Command::AddNoGo`]
    AddNoGo(GivenNoGo),
    /// [`Command::AddNoGo`] of one that has a name.
    AddNamedNoGo(GivenNoGo, String),
    /// [`Command::RemoveNoGo`] by its number.
    RemoveNoGo(u16),
    /// [`Command::NameNoGo`]
    NameNoGo {
        /// Its number.
        number: u16,
        /// Its name; absent = none any more.
        name: Option<String>,
    },
    /// [`Command::KeepPlace`]
    KeepPlace {
        /// Its name.
        name: String,
        /// Where.
        place: GivenPart,
        /// The number that it had.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        number: Option<u16>,
    },
    /// [`Command::NamePlace`]
    NamePlace {
        /// Its number.
        number: u16,
        /// Its name.
        name: String,
    },
    /// [`Command::ForgetPlace`] by its number.
    ForgetPlace(u16),
    /// [`Command::NameRoom`]
    NameRoom {
        /// Identity of the room.
        room: u16,
        /// Its name; absent = none any more.
        name: Option<String>,
    },
    /// [`Command::SetRoom`]
    SetRoom {
        /// Identity of the room.
        room: u16,
        /// Passes, then percent of suction, main brush and side brushes; absent = as any other.
        settings: Option<[u8; 4]>,
        /// Absent = lines.
        #[serde(default, skip_serializing_if = "GivenPattern::is_usual")]
        pattern: GivenPattern,
    },
    /// [`Command::SplitRoom`]
    SplitRoom {
        /// Identity of the room.
        room: Option<u16>,
        /// The ends of the line.
        line: [[f64; 2]; 2],
    },
    /// [`Command::JoinRooms`] by their identities.
    JoinRooms([u16; 2]),
    /// [`Command::UndoRoomChange`] by its number.
    UndoRoomChange(u16),
    /// [`Command::MoveDock`] by place and heading of a robot on it.
    MoveDock([f64; 3]),
    /// [`Command::Spot`]
    Spot,
    /// [`Command::Pause`]
    Pause,
    /// [`Command::Resume`]
    Resume,
    /// [`Command::Stop`]
    Stop,
    /// [`Command::Dock`]
    Dock,
    /// [`Command::Manual`]
    Manual {
        /// Forward speed.
        speed_m_per_s: f64,
        /// Turn rate.
        turn_rad_per_s: f64,
        /// End of the lease.
        valid_until_us: u64,
        /// Brushes and suction.
        cleaners: bool,
    },
    /// [`Command::ManualEnd`]
    ManualEnd,
    /// [`Command::ClearError`]
    ClearError,
}

impl From<&Command> for GivenCommand {
    fn from(command: &Command) -> Self {
        match command {
            Command::Clean { strategy } => Self::Clean(strategy.name().to_owned()),
            Command::CleanParts { order } => Self::CleanParts(order.into()),
            Command::AddNoGo { no_go } => match no_go.name() {
                None => Self::AddNoGo(no_go.into()),
                Some(name) => Self::AddNamedNoGo(no_go.into(), name.as_str().to_owned()),
            },
            Command::RemoveNoGo { number } => Self::RemoveNoGo(*number),
            Command::NameNoGo { number, name } => Self::NameNoGo {
                number: *number,
                name: from_name(name.as_ref()),
            },
            Command::KeepPlace { place, number } => Self::KeepPlace {
                name: place.name().as_str().to_owned(),
                place: GivenPart::from(&place.part()),
                number: *number,
            },
            Command::NamePlace { number, name } => Self::NamePlace {
                number: *number,
                name: name.as_str().to_owned(),
            },
            Command::ForgetPlace { number } => Self::ForgetPlace(*number),
            Command::NameRoom { room, name } => Self::NameRoom {
                room: *room,
                name: from_name(name.as_ref()),
            },
            Command::SetRoom { room, settings } => Self::SetRoom {
                room: *room,
                settings: settings.map(|settings| {
                    let [suction, main_brush, side_brushes] = from_power(settings.power());
                    [settings.passes(), suction, main_brush, side_brushes]
                }),
                pattern: settings.unwrap_or_default().pattern().into(),
            },
            Command::SplitRoom { room, line } => Self::SplitRoom {
                room: *room,
                line: line.ends().map(|end| [end.x_m, end.y_m]),
            },
            Command::JoinRooms { rooms } => Self::JoinRooms(*rooms),
            Command::UndoRoomChange { number } => Self::UndoRoomChange(*number),
            Command::MoveDock { pose } => Self::MoveDock([pose.x_m, pose.y_m, pose.heading_rad]),
            Command::Spot => Self::Spot,
            Command::Pause => Self::Pause,
            Command::Resume => Self::Resume,
            Command::Stop => Self::Stop,
            Command::Dock => Self::Dock,
            Command::Manual {
                speed_m_per_s,
                turn_rad_per_s,
                valid_until_us,
                cleaners,
            } => Self::Manual {
                speed_m_per_s: *speed_m_per_s,
                turn_rad_per_s: *turn_rad_per_s,
                valid_until_us: *valid_until_us,
                cleaners: *cleaners,
            },
            Command::ManualEnd => Self::ManualEnd,
            Command::ClearError => Self::ClearError,
        }
    }
}

fn from_name(name: Option<&RoomName>) -> Option<String> {
    name.map(|name| name.as_str().to_owned())
}

/// `None` for a name that the brain would refuse.
fn to_name(name: Option<&str>) -> Option<Option<RoomName>> {
    name.map(RoomName::new).transpose().ok()
}

impl GivenCommand {
    /// Back to the brain's own type; `None` for a strategy that this version does not have.
    #[must_use]
    pub fn to_brain(&self) -> Option<Command> {
        Some(match self {
            Self::Clean(strategy) => Command::Clean {
                strategy: StrategyName::from_name(strategy)?,
            },
            Self::CleanParts(order) => Command::CleanParts {
                order: order.to_brain()?,
            },
            Self::AddNoGo(no_go) => Command::AddNoGo {
                no_go: no_go.to_brain()?,
            },
            Self::AddNamedNoGo(no_go, name) => Command::AddNoGo {
                no_go: no_go.to_brain()?.with_name(Some(RoomName::new(name).ok()?)),
            },
            Self::RemoveNoGo(number) => Command::RemoveNoGo { number: *number },
            Self::NameNoGo { number, name } => Command::NameNoGo {
                number: *number,
                name: to_name(name.as_deref())?,
            },
            Self::KeepPlace { name, place, number } => Command::KeepPlace {
                place: KeptPlace::new(RoomName::new(name).ok()?, &place.to_shape()?).ok()?,
                number: *number,
            },
            Self::NamePlace { number, name } => Command::NamePlace {
                number: *number,
                name: RoomName::new(name).ok()?,
            },
            Self::ForgetPlace(number) => Command::ForgetPlace { number: *number },
            Self::NameRoom { room, name } => Command::NameRoom {
                room: *room,
                name: to_name(name.as_deref())?,
            },
            Self::SetRoom {
                room,
                settings,
                pattern,
            } => Command::SetRoom {
                room: *room,
                settings: match settings {
                    None => None,
                    Some([passes, power @ ..]) => {
                        let settings = RoomSettings::new(*passes, to_power(*power)).ok()?;
                        Some(settings.with_pattern(pattern.to_brain()))
                    }
                },
            },
            Self::SplitRoom { room, line } => {
                let [from, to] = line.map(|[x_m, y_m]| Point2 { x_m, y_m });
                Command::SplitRoom {
                    room: *room,
                    line: CutLine::new(from, to).ok()?,
                }
            }
            Self::JoinRooms(rooms) => Command::JoinRooms { rooms: *rooms },
            Self::UndoRoomChange(number) => Command::UndoRoomChange { number: *number },
            Self::MoveDock([x_m, y_m, heading_rad]) => Command::MoveDock {
                pose: Pose2 {
                    x_m: *x_m,
                    y_m: *y_m,
                    heading_rad: *heading_rad,
                },
            },
            Self::Spot => Command::Spot,
            Self::Pause => Command::Pause,
            Self::Resume => Command::Resume,
            Self::Stop => Command::Stop,
            Self::Dock => Command::Dock,
            Self::Manual {
                speed_m_per_s,
                turn_rad_per_s,
                valid_until_us,
                cleaners,
            } => Command::Manual {
                speed_m_per_s: *speed_m_per_s,
                turn_rad_per_s: *turn_rad_per_s,
                valid_until_us: *valid_until_us,
                cleaners: *cleaners,
            },
            Self::ManualEnd => Command::ManualEnd,
            Self::ClearError => Command::ClearError,
        })
    }
}

#[cfg(test)]
mod tests {
    use brain::mapping::CutLine;
    use brain::observation::{BeaconRange, ChargeFlow};
    use brain::{
        CleaningOrder, Command, HomePart, KeptPlace, NoGo, Observation, Pattern, PlaceShape, Point2, Pose2,
        RoomName, RoomPower, RoomSettings, Zone,
    };

    use super::{Given, GivenCommand, Seen};

    #[test]
    fn observations_come_back_bit_for_bit() {
        let observation = Observation {
            time_us: u64::MAX / 3,
            travel_left_m: 0.1 + 0.2,
            travel_right_m: -1.0 / 3.0,
            gyro_heading_rad: Some(f64::MIN_POSITIVE),
            proximity: vec![1.0 / 255.0, 0.7],
            inhibits: vec!["wheel-drop", "unknown-inhibit"],
            battery_charge: Some(0.3),
            charge_flow: Some(ChargeFlow::Missing),
            beacon_ranges: vec![BeaconRange {
                beacon: 3,
                range_m: 4.1,
                sigma_m: 0.2,
            }],
            ..Observation::default()
        };
        let text = serde_json::to_string(&Seen::from(&observation)).expect("plain");
        let back: Seen = serde_json::from_str(&text).expect("just written");
        assert_eq!(back.to_brain(), observation);
    }

    #[test]
    fn commands_come_back() {
        let corners = [(0.0, 0.1), (1.0 / 3.0, 0.0), (-1.0, 2.0)].map(|(x_m, y_m)| Point2 { x_m, y_m });
        let zone = Zone::new(corners.to_vec()).expect("a triangle");
        let manual = Command::Manual {
            speed_m_per_s: 0.1,
            turn_rad_per_s: -0.3,
            valid_until_us: 7,
            cleaners: true,
        };
        for command in [
            Command::Spot,
            manual,
            Command::CleanParts {
                order: CleaningOrder::new(
                    vec![
                        HomePart::Room(3),
                        HomePart::Zone(zone.clone()),
                        HomePart::Spot(corners[0]),
                    ],
                    2,
                )
                .and_then(|order| order.avoiding(vec![NoGo::zone(&zone)?]))
                .expect("a good order"),
            },
            Command::AddNoGo {
                no_go: NoGo::zone(&zone).expect("a good zone"),
            },
            Command::AddNoGo {
                no_go: NoGo::wall(corners[0], corners[1]).expect("two places"),
            },
            Command::AddNoGo {
                no_go: NoGo::wall(corners[0], corners[1])
                    .expect("two places")
                    .with_name(RoomName::new("Cats").ok()),
            },
            Command::KeepPlace {
                place: kept_place(PlaceShape::Zone(zone.clone())),
                number: None,
            },
            Command::KeepPlace {
                place: kept_place(PlaceShape::Spot(corners[1])),
                number: Some(3),
            },
            Command::NamePlace {
                number: 3,
                name: RoomName::new("Bowl").expect("a good name"),
            },
            Command::ForgetPlace { number: 3 },
            Command::RemoveNoGo { number: 7 },
            Command::NameNoGo {
                number: 7,
                name: RoomName::new("Bowl").ok(),
            },
            Command::NameNoGo {
                number: 7,
                name: None,
            },
            Command::NameRoom {
                room: 3,
                name: Some(RoomName::new("Köök").expect("a good name")),
            },
            Command::NameRoom { room: 3, name: None },
            Command::SplitRoom {
                room: Some(3),
                line: CutLine::new(corners[0], corners[1]).expect("two places"),
            },
            Command::JoinRooms { rooms: [3, 4] },
            Command::SetRoom {
                room: 3,
                settings: RoomSettings::new(2, RoomPower::FULL).ok(),
            },
            Command::SetRoom {
                room: 3,
                settings: None,
            },
            Command::UndoRoomChange { number: 2 },
            Command::MoveDock {
                pose: Pose2 {
                    x_m: 0.1 + 0.2,
                    y_m: -1.0 / 3.0,
                    heading_rad: 3.0,
                },
            },
            Command::Clean {
                strategy: brain::StrategyName::Bounce,
            },
        ] {
            comes_back(command);
        }
    }

    #[test]
    fn how_rooms_and_jobs_are_swept_comes_back() {
        for command in [
            Command::SetRoom {
                room: 3,
                settings: Some(RoomSettings::default().with_pattern(Pattern::Contour)),
            },
            Command::CleanParts {
                order: CleaningOrder::default()
                    .with_pattern(Pattern::Contour)
                    .with_power(RoomPower {
                        suction: 30,
                        ..RoomPower::FULL
                    })
                    .expect("a power that can be"),
            },
        ] {
            comes_back(command);
        }
    }

    fn kept_place(shape: PlaceShape) -> KeptPlace {
        KeptPlace::new(RoomName::new("Table").expect("a good name"), &shape).expect("a good place")
    }

    fn comes_back(command: Command) {
        let given = Given {
            time_us: 1,
            command: GivenCommand::from(&command),
        };
        let text = serde_json::to_string(&given).expect("plain");
        let back: Given = serde_json::from_str(&text).expect("just written");
        assert_eq!(back.command.to_brain(), Some(command));
    }
}
