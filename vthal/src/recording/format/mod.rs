//! The recorded forms of the brain's types, and the conversions in both directions.
//!
//! Numbers are written so that reading them gives the same bits again; a replay rests on it.

mod answer;
mod command;
mod earlier_map_edit;
mod flow;
mod order;
mod packet;
mod sensors;
mod state;

pub use answer::{Answered, AnsweredNames, DecisionNames};
pub use command::{GivenCommand, GivenJobCommand};
pub use earlier_map_edit::EarlierMapEdit;
pub use order::GivenOrder;
pub use packet::SentPacket;
pub use state::BrainState;

use brain::observation::{BeaconRange, BeaconSignal, BeaconStrength, Cliffs, Contacts, MotorCurrents};
use brain::{Body, BrainConfig, Inhibits, Observation, Speeds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use vthal_core::RunStart;

use flow::FlowName;
use sensors::SensorSettings;

/// Version of these forms, and of what the brain answers to commands. Raised when a recording must be replayed otherwise than those
/// before, or cannot be replayed any more.
pub const FORMAT: u32 = 2;

/// Version of recordings whose brains judged each edit a second time, against the map that had it already. They may hold a `refuse`
/// for an edit that was made.
pub const FORMAT_WITH_FALSE_REFUSALS: u32 = 1;

/// Beginning of a run.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
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
    #[schemars(with = "Map<String, Value>")]
    pub config: BrainSettings,
    /// What the brain took up.
    #[schemars(with = "Map<String, Value>")]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
    /// Left wheel, right wheel, main brush, amperes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    currents_a: Option<[f32; 3]>,
    /// The third of them is not measured.
    #[serde(default, skip_serializing_if = "is_false")]
    no_brush_current: bool,
    inhibits: Vec<String>,
    link_up: bool,
    speed_share: f64,
    /// Number, range and its deviation of each beacon that was measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<Vec<f64>>")]
    beacons: Vec<(u16, f64, f64)>,
    /// Number and received power of each beacon of which only that was measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<Vec<f64>>")]
    strengths: Vec<(u16, f64)>,
    /// Number of beacons whose distance was measured lately; absent where there are none, and in recordings of earlier versions.
    #[serde(default, skip_serializing_if = "is_zero")]
    beacons_in_range: u8,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde calls it with a reference"
)]
fn is_zero(value: &u8) -> bool {
    *value == 0
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde calls it with a reference"
)]
fn is_false(value: &bool) -> bool {
    !*value
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
            currents_a: seen.currents.map(|all| {
                [
                    all.wheel_left_a,
                    all.wheel_right_a,
                    all.brush_main_a.unwrap_or(0.0),
                ]
            }),
            no_brush_current: seen.currents.is_some_and(|all| all.brush_main_a.is_none()),
            inhibits: seen.inhibits.names().map(str::to_owned).collect(),
            link_up: seen.link_up,
            speed_share: seen.speed_share,
            beacons: seen.beacons.iter().filter_map(range).collect(),
            strengths: seen.beacons.iter().filter_map(strength).collect(),
            beacons_in_range: seen.beacons_in_range,
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
            currents: self.currents_a.map(|[left, right, brush]| MotorCurrents {
                wheel_left_a: left,
                wheel_right_a: right,
                brush_main_a: (!self.no_brush_current).then_some(brush),
            }),
            inhibits: Inhibits::from_names(self.inhibits.iter().map(String::as_str)),
            link_up: self.link_up,
            speed_share: self.speed_share,
            beacons: self.signals(),
            beacons_in_range: self.beacons_in_range,
        }
    }

    /// First the ranges: the beacon readings of a step have no order.
    fn signals(&self) -> Vec<BeaconSignal> {
        let ranges = self.beacons.iter().map(|&(beacon, range_m, sigma_m)| {
            BeaconSignal::Range(BeaconRange {
                beacon,
                range_m,
                sigma_m,
            })
        });
        let strengths = self
            .strengths
            .iter()
            .map(|&(beacon, dbm)| BeaconSignal::Strength(BeaconStrength { beacon, dbm }));
        ranges.chain(strengths).collect()
    }
}

fn range(signal: &BeaconSignal) -> Option<(u16, f64, f64)> {
    match signal {
        BeaconSignal::Range(range) => Some((range.beacon, range.range_m, range.sigma_m)),
        BeaconSignal::Strength(_) => None,
    }
}

fn strength(signal: &BeaconSignal) -> Option<(u16, f64)> {
    match signal {
        BeaconSignal::Strength(strength) => Some((strength.beacon, strength.dbm)),
        BeaconSignal::Range(_) => None,
    }
}

/// [`Command`] with the time at which it was given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Given {
    /// Host time in microseconds.
    pub time_us: u64,
    /// What.
    #[schemars(with = "Value")]
    pub command: GivenCommand,
}

#[cfg(test)]
mod tests {
    use brain::CutLine;
    use brain::observation::{BeaconRange, BeaconSignal, BeaconStrength, ChargeFlow, MotorCurrents};
    use brain::{
        CleaningOrder, Command, HomePart, Inhibits, JobCommand, KeptPlace, MapEdit, NoGo, NoGoEdit,
        Observation, Pattern, PlaceEdit, PlaceShape, Point2, Pose2, RoomEdit, RoomName, RoomPower,
        RoomSettings, Zone,
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
            inhibits: Inhibits::from_names(["wheel-drop", "unknown-inhibit"]),
            battery_charge: Some(0.3),
            charge_flow: Some(ChargeFlow::Missing),
            currents: Some(MotorCurrents {
                wheel_left_a: 0.1,
                wheel_right_a: -1.0 / 3.0,
                brush_main_a: Some(0.55),
            }),
            beacons: vec![
                BeaconSignal::Range(BeaconRange {
                    beacon: 3,
                    range_m: 4.1,
                    sigma_m: 0.2,
                }),
                BeaconSignal::Strength(BeaconStrength {
                    beacon: 4,
                    dbm: -71.3,
                }),
            ],
            ..Observation::default()
        };
        let text = serde_json::to_string(&Seen::from(&observation)).expect("plain");
        let back: Seen = serde_json::from_str(&text).expect("just written");
        assert_eq!(back.to_brain(), observation);
    }

    #[test]
    fn commands_come_back() {
        let corners = corners();
        let zone = Zone::new(corners.to_vec()).expect("a triangle");
        let manual = JobCommand::Manual {
            speed_m_per_s: 0.1,
            turn_rad_per_s: -0.3,
            valid_until_us: 7,
            cleaners: true,
        };
        for command in [
            JobCommand::Spot,
            manual,
            JobCommand::CleanParts {
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
            JobCommand::Clean {
                strategy: brain::StrategyName::Bounce,
            },
        ] {
            comes_back(&command.into());
        }
    }

    #[test]
    fn changes_of_places_come_back() {
        let corners = corners();
        let zone = Zone::new(corners.to_vec()).expect("a triangle");
        for command in [
            MapEdit::NoGo(NoGoEdit::Add(NoGo::zone(&zone).expect("a good zone"))),
            MapEdit::NoGo(NoGoEdit::Add(
                NoGo::wall(corners[0], corners[1]).expect("two places"),
            )),
            MapEdit::NoGo(NoGoEdit::Add(
                NoGo::wall(corners[0], corners[1])
                    .expect("two places")
                    .with_name(RoomName::new("Cats").ok()),
            )),
            MapEdit::Place(PlaceEdit::Keep {
                place: kept_place(PlaceShape::Zone(zone.clone())),
                number: None,
            }),
            MapEdit::Place(PlaceEdit::Keep {
                place: kept_place(PlaceShape::Spot(corners[1])),
                number: Some(3),
            }),
            MapEdit::Place(PlaceEdit::Name {
                number: 3,
                name: RoomName::new("Bowl").expect("a good name"),
            }),
            MapEdit::Place(PlaceEdit::Reshape {
                number: 3,
                shape: PlaceShape::Zone(zone.clone()),
            }),
            MapEdit::Place(PlaceEdit::Reshape {
                number: 3,
                shape: PlaceShape::Spot(corners[1]),
            }),
            MapEdit::NoGo(NoGoEdit::Reshape {
                number: 7,
                no_go: NoGo::zone(&zone).expect("is near"),
            }),
            MapEdit::Place(PlaceEdit::Forget { number: 3 }),
            MapEdit::NoGo(NoGoEdit::Remove { number: 7 }),
            MapEdit::NoGo(NoGoEdit::Name {
                number: 7,
                name: RoomName::new("Bowl").ok(),
            }),
            MapEdit::NoGo(NoGoEdit::Name {
                number: 7,
                name: None,
            }),
        ] {
            comes_back(&command.into());
        }
    }

    #[test]
    fn changes_of_rooms_and_dock_come_back() {
        let corners = corners();
        for command in [
            MapEdit::Room(RoomEdit::Name {
                room: 3,
                name: Some(RoomName::new("Köök").expect("a good name")),
            }),
            MapEdit::Room(RoomEdit::Name { room: 3, name: None }),
            MapEdit::Room(RoomEdit::Split {
                room: Some(3),
                line: CutLine::new(corners[0], corners[1]).expect("two places"),
            }),
            MapEdit::Room(RoomEdit::Join { rooms: [3, 4] }),
            MapEdit::Room(RoomEdit::Set {
                room: 3,
                settings: RoomSettings::new(2, RoomPower::FULL).ok(),
            }),
            MapEdit::Room(RoomEdit::Set {
                room: 3,
                settings: None,
            }),
            MapEdit::Room(RoomEdit::Undo { number: 2 }),
            MapEdit::Dock(Pose2 {
                x_m: 0.1 + 0.2,
                y_m: -1.0 / 3.0,
                heading_rad: 3.0,
            }),
        ] {
            comes_back(&command.into());
        }
    }

    #[test]
    fn how_rooms_and_jobs_are_swept_comes_back() {
        for command in [
            Command::Edit(MapEdit::Room(RoomEdit::Set {
                room: 3,
                settings: Some(RoomSettings::default().with_pattern(Pattern::Contour)),
            })),
            Command::Job(JobCommand::CleanParts {
                order: CleaningOrder::default()
                    .with_pattern(Pattern::Contour)
                    .with_power(RoomPower {
                        suction: 30,
                        ..RoomPower::FULL
                    })
                    .expect("a power that can be"),
            }),
        ] {
            comes_back(&command);
        }
    }

    fn corners() -> [Point2; 3] {
        [(0.0, 0.1), (1.0 / 3.0, 0.0), (-1.0, 2.0)].map(|(x_m, y_m)| Point2 { x_m, y_m })
    }

    fn kept_place(shape: PlaceShape) -> KeptPlace {
        KeptPlace::new(RoomName::new("Table").expect("a good name"), &shape).expect("a good place")
    }

    fn comes_back(command: &Command) {
        let given = Given {
            time_us: 1,
            command: GivenCommand::from(command),
        };
        let text = serde_json::to_string(&given).expect("plain");
        let back: Given = serde_json::from_str(&text).expect("just written");
        assert_eq!(back.command.to_brain().as_ref(), Some(command));
    }
}
