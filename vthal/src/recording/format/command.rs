//! What people and schedules asked of the brain, as it stands in recordings.

use brain::CutLine;
use brain::{Command, KeptPlace, Point2, Pose2, RoomName, RoomSettings, StrategyName};
use rvac_api::{CleaningPattern, NoGoShape, PlaceShape};
use serde::{Deserialize, Serialize};
use vthal_core::api_forms;

use super::order::{GivenOrder, from_power, to_power};

/// [`Command`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GivenCommand {
    /// [`Command::Clean`] by the strategy's name.
    Clean(String),
    /// [`Command::CleanParts`]
    CleanParts(GivenOrder),
    /// [`Command::AddNoGo`]
    AddNoGo(NoGoShape),
    /// [`Command::AddNoGo`] of one that has a name.
    AddNamedNoGo(NoGoShape, String),
    /// [`Command::RemoveNoGo`] by its number.
    RemoveNoGo(u16),
    /// [`Command::NameNoGo`]
    NameNoGo {
        /// Its number.
        number: u16,
        /// Its name; absent = none any more.
        name: Option<String>,
    },
    /// [`Command::ReshapeNoGo`]
    ReshapeNoGo {
        /// Its number.
        number: u16,
        /// Where it is from now on.
        no_go: NoGoShape,
    },
    /// [`Command::KeepPlace`]
    KeepPlace {
        /// Its name.
        name: String,
        /// Where.
        place: PlaceShape,
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
    /// [`Command::ReshapePlace`]
    ReshapePlace {
        /// Its number.
        number: u16,
        /// Where it is from now on.
        place: PlaceShape,
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
        #[serde(default, skip_serializing_if = "CleaningPattern::is_usual")]
        pattern: CleaningPattern,
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
                None => Self::AddNoGo(api_forms::no_go(no_go)),
                Some(name) => Self::AddNamedNoGo(api_forms::no_go(no_go), name.as_str().to_owned()),
            },
            Command::RemoveNoGo { number } => Self::RemoveNoGo(*number),
            Command::NameNoGo { number, name } => Self::NameNoGo {
                number: *number,
                name: from_name(name.as_ref()),
            },
            Command::ReshapeNoGo { number, no_go } => Self::ReshapeNoGo {
                number: *number,
                no_go: api_forms::no_go(no_go),
            },
            Command::KeepPlace { place, number } => Self::KeepPlace {
                name: place.name().as_str().to_owned(),
                place: api_forms::place(place.shape()),
                number: *number,
            },
            Command::NamePlace { number, name } => Self::NamePlace {
                number: *number,
                name: name.as_str().to_owned(),
            },
            Command::ReshapePlace { number, shape } => Self::ReshapePlace {
                number: *number,
                place: api_forms::place(shape),
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
                pattern: api_forms::pattern(settings.unwrap_or_default().pattern()),
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
            Self::AddNoGo(..)
            | Self::AddNamedNoGo(..)
            | Self::RemoveNoGo(..)
            | Self::NameNoGo { .. }
            | Self::ReshapeNoGo { .. }
            | Self::KeepPlace { .. }
            | Self::NamePlace { .. }
            | Self::ReshapePlace { .. }
            | Self::ForgetPlace(..)
            | Self::NameRoom { .. }
            | Self::SetRoom { .. }
            | Self::SplitRoom { .. }
            | Self::JoinRooms(..)
            | Self::UndoRoomChange(..)
            | Self::MoveDock(..) => return self.edit_to_brain(),
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

    /// The same of what people change of the home.
    fn edit_to_brain(&self) -> Option<Command> {
        Some(match self {
            Self::AddNoGo(no_go) => Command::AddNoGo {
                no_go: api_forms::to_no_go(no_go)?,
            },
            Self::AddNamedNoGo(no_go, name) => Command::AddNoGo {
                no_go: api_forms::to_no_go(no_go)?.with_name(Some(RoomName::new(name).ok()?)),
            },
            Self::RemoveNoGo(number) => Command::RemoveNoGo { number: *number },
            Self::NameNoGo { number, name } => Command::NameNoGo {
                number: *number,
                name: to_name(name.as_deref())?,
            },
            Self::ReshapeNoGo { number, no_go } => Command::ReshapeNoGo {
                number: *number,
                no_go: api_forms::to_no_go(no_go)?,
            },
            Self::KeepPlace { name, place, number } => Command::KeepPlace {
                place: KeptPlace::new(RoomName::new(name).ok()?, &api_forms::to_place(place)?).ok()?,
                number: *number,
            },
            Self::NamePlace { number, name } => Command::NamePlace {
                number: *number,
                name: RoomName::new(name).ok()?,
            },
            Self::ReshapePlace { number, place } => Command::ReshapePlace {
                number: *number,
                shape: api_forms::to_place(place)?,
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
                        Some(settings.with_pattern(api_forms::to_pattern(*pattern)))
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
            _ => return None,
        })
    }
}
