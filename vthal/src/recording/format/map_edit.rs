//! Edits of the map, as recordings have them.

use brain::{CutLine, KeptPlace, NoGoEdit, PlaceEdit, Point2, Pose2, RoomEdit, RoomName, RoomSettings};
use rvac_api::{CleaningPattern, NoGoShape, PlaceShape};
use serde::{Deserialize, Serialize};
use vthal_core::api_forms;

use super::order::{from_power, to_power};

/// [`NoGoEdit`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GivenNoGoEdit {
    /// [`NoGoEdit::Add`]
    AddNoGo(NoGoShape),
    /// [`NoGoEdit::Add`] of one that has a name.
    AddNamedNoGo(NoGoShape, String),
    /// [`NoGoEdit::Remove`] by its number.
    RemoveNoGo(u16),
    /// [`NoGoEdit::Name`]
    NameNoGo {
        /// Its number.
        number: u16,
        /// Its name; absent = none any more.
        name: Option<String>,
    },
    /// [`NoGoEdit::Reshape`]
    ReshapeNoGo {
        /// Its number.
        number: u16,
        /// Where it is from now on.
        no_go: NoGoShape,
    },
}

impl From<&NoGoEdit> for GivenNoGoEdit {
    fn from(edit: &NoGoEdit) -> Self {
        match edit {
            NoGoEdit::Add(no_go) => match no_go.name() {
                None => Self::AddNoGo(api_forms::no_go(no_go)),
                Some(name) => Self::AddNamedNoGo(api_forms::no_go(no_go), name.as_str().to_owned()),
            },
            NoGoEdit::Remove { number } => Self::RemoveNoGo(*number),
            NoGoEdit::Name { number, name } => Self::NameNoGo {
                number: *number,
                name: from_name(name.as_ref()),
            },
            NoGoEdit::Reshape { number, no_go } => Self::ReshapeNoGo {
                number: *number,
                no_go: api_forms::no_go(no_go),
            },
        }
    }
}

impl GivenNoGoEdit {
    pub(super) fn to_brain(&self) -> Option<NoGoEdit> {
        Some(match self {
            Self::AddNoGo(no_go) => NoGoEdit::Add(api_forms::to_no_go(no_go)?),
            Self::AddNamedNoGo(no_go, name) => {
                let name = RoomName::new(name).ok()?;
                NoGoEdit::Add(api_forms::to_no_go(no_go)?.with_name(Some(name)))
            }
            Self::RemoveNoGo(number) => NoGoEdit::Remove { number: *number },
            Self::NameNoGo { number, name } => NoGoEdit::Name {
                number: *number,
                name: to_name(name.as_deref())?,
            },
            Self::ReshapeNoGo { number, no_go } => NoGoEdit::Reshape {
                number: *number,
                no_go: api_forms::to_no_go(no_go)?,
            },
        })
    }
}

/// [`PlaceEdit`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GivenPlaceEdit {
    /// [`PlaceEdit::Keep`]
    KeepPlace {
        /// Its name.
        name: String,
        /// Where.
        place: PlaceShape,
        /// The number that it had.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        number: Option<u16>,
    },
    /// [`PlaceEdit::Name`]
    NamePlace {
        /// Its number.
        number: u16,
        /// Its name.
        name: String,
    },
    /// [`PlaceEdit::Reshape`]
    ReshapePlace {
        /// Its number.
        number: u16,
        /// Where it is from now on.
        place: PlaceShape,
    },
    /// [`PlaceEdit::Forget`] by its number.
    ForgetPlace(u16),
}

impl From<&PlaceEdit> for GivenPlaceEdit {
    fn from(edit: &PlaceEdit) -> Self {
        match edit {
            PlaceEdit::Keep { place, number } => Self::KeepPlace {
                name: place.name().as_str().to_owned(),
                place: api_forms::place(place.shape()),
                number: *number,
            },
            PlaceEdit::Name { number, name } => Self::NamePlace {
                number: *number,
                name: name.as_str().to_owned(),
            },
            PlaceEdit::Reshape { number, shape } => Self::ReshapePlace {
                number: *number,
                place: api_forms::place(shape),
            },
            PlaceEdit::Forget { number } => Self::ForgetPlace(*number),
        }
    }
}

impl GivenPlaceEdit {
    pub(super) fn to_brain(&self) -> Option<PlaceEdit> {
        Some(match self {
            Self::KeepPlace { name, place, number } => PlaceEdit::Keep {
                place: KeptPlace::new(RoomName::new(name).ok()?, &api_forms::to_place(place)?).ok()?,
                number: *number,
            },
            Self::NamePlace { number, name } => PlaceEdit::Name {
                number: *number,
                name: RoomName::new(name).ok()?,
            },
            Self::ReshapePlace { number, place } => PlaceEdit::Reshape {
                number: *number,
                shape: api_forms::to_place(place)?,
            },
            Self::ForgetPlace(number) => PlaceEdit::Forget { number: *number },
        })
    }
}

/// [`RoomEdit`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GivenRoomEdit {
    /// [`RoomEdit::Name`]
    NameRoom {
        /// Identity of the room.
        room: u16,
        /// Its name; absent = none any more.
        name: Option<String>,
    },
    /// [`RoomEdit::Set`]
    SetRoom {
        /// Identity of the room.
        room: u16,
        /// Passes, then percent of suction, main brush and side brushes; absent = as any other.
        settings: Option<[u8; 4]>,
        /// Absent = lines.
        #[serde(default, skip_serializing_if = "CleaningPattern::is_usual")]
        pattern: CleaningPattern,
    },
    /// [`RoomEdit::Split`]
    SplitRoom {
        /// Identity of the room.
        room: Option<u16>,
        /// The ends of the line.
        line: [[f64; 2]; 2],
    },
    /// [`RoomEdit::Join`] by their identities.
    JoinRooms([u16; 2]),
    /// [`RoomEdit::Undo`] by its number.
    UndoRoomChange(u16),
}

impl From<&RoomEdit> for GivenRoomEdit {
    fn from(edit: &RoomEdit) -> Self {
        match edit {
            RoomEdit::Name { room, name } => Self::NameRoom {
                room: *room,
                name: from_name(name.as_ref()),
            },
            RoomEdit::Set { room, settings } => Self::SetRoom {
                room: *room,
                settings: settings.map(|settings| {
                    let [suction, main_brush, side_brushes] = from_power(settings.power());
                    [settings.passes(), suction, main_brush, side_brushes]
                }),
                pattern: api_forms::pattern(settings.unwrap_or_default().pattern()),
            },
            RoomEdit::Split { room, line } => Self::SplitRoom {
                room: *room,
                line: line.ends().map(|end| [end.x_m, end.y_m]),
            },
            RoomEdit::Join { rooms } => Self::JoinRooms(*rooms),
            RoomEdit::Undo { number } => Self::UndoRoomChange(*number),
        }
    }
}

impl GivenRoomEdit {
    pub(super) fn to_brain(&self) -> Option<RoomEdit> {
        Some(match self {
            Self::NameRoom { room, name } => RoomEdit::Name {
                room: *room,
                name: to_name(name.as_deref())?,
            },
            Self::SetRoom {
                room,
                settings,
                pattern,
            } => RoomEdit::Set {
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
                RoomEdit::Split {
                    room: *room,
                    line: CutLine::new(from, to).ok()?,
                }
            }
            Self::JoinRooms(rooms) => RoomEdit::Join { rooms: *rooms },
            Self::UndoRoomChange(number) => RoomEdit::Undo { number: *number },
        })
    }
}

/// [`brain::MapEdit::Dock`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GivenDockEdit {
    /// Position and heading of a robot on it.
    MoveDock([f64; 3]),
}

impl From<&Pose2> for GivenDockEdit {
    fn from(pose: &Pose2) -> Self {
        Self::MoveDock([pose.x_m, pose.y_m, pose.heading_rad])
    }
}

impl GivenDockEdit {
    pub(super) fn to_brain(&self) -> Pose2 {
        let Self::MoveDock([x_m, y_m, heading_rad]) = *self;
        Pose2 {
            x_m,
            y_m,
            heading_rad,
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
