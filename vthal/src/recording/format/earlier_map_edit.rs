//! Edits of the map in recordings of earlier versions. New recordings keep them as clients ask for them, so nothing is added here.

use brain::{
    CutLine, KeptPlace, MapEdit, NoGoEdit, PlaceEdit, Point2, Pose2, RoomEdit, RoomName, RoomSettings,
};
use rvac_api::{CleaningPattern, NoGoShape, PlaceShape};
use serde::{Deserialize, Serialize};
use vthal_core::api_forms;

use super::order::to_power;

/// [`MapEdit`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EarlierMapEdit {
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
    /// [`MapEdit::Dock`]: position and heading of a robot on it.
    MoveDock([f64; 3]),
}

impl EarlierMapEdit {
    /// `None` for what the brain would refuse.
    pub(super) fn to_brain(&self) -> Option<MapEdit> {
        use MapEdit::{NoGo, Place, Room};
        Some(match self {
            Self::AddNoGo(no_go) => NoGo(NoGoEdit::Add(api_forms::to_no_go(no_go)?)),
            Self::AddNamedNoGo(no_go, name) => {
                let name = RoomName::new(name).ok()?;
                NoGo(NoGoEdit::Add(api_forms::to_no_go(no_go)?.with_name(Some(name))))
            }
            Self::RemoveNoGo(number) => NoGo(NoGoEdit::Remove { number: *number }),
            Self::NameNoGo { number, name } => NoGo(NoGoEdit::Name {
                number: *number,
                name: to_name(name.as_deref())?,
            }),
            Self::ReshapeNoGo { number, no_go } => NoGo(NoGoEdit::Reshape {
                number: *number,
                no_go: api_forms::to_no_go(no_go)?,
            }),
            Self::KeepPlace { name, place, number } => Place(PlaceEdit::Keep {
                place: KeptPlace::new(RoomName::new(name).ok()?, &api_forms::to_place(place)?).ok()?,
                number: *number,
            }),
            Self::NamePlace { number, name } => Place(PlaceEdit::Name {
                number: *number,
                name: RoomName::new(name).ok()?,
            }),
            Self::ReshapePlace { number, place } => Place(PlaceEdit::Reshape {
                number: *number,
                shape: api_forms::to_place(place)?,
            }),
            Self::ForgetPlace(number) => Place(PlaceEdit::Forget { number: *number }),
            Self::NameRoom { room, name } => Room(RoomEdit::Name {
                room: *room,
                name: to_name(name.as_deref())?,
            }),
            Self::SetRoom {
                room,
                settings,
                pattern,
            } => Room(RoomEdit::Set {
                room: *room,
                settings: match settings {
                    None => None,
                    Some([passes, power @ ..]) => {
                        let settings = RoomSettings::new(*passes, to_power(*power)).ok()?;
                        Some(settings.with_pattern(api_forms::to_pattern(*pattern)))
                    }
                },
            }),
            Self::SplitRoom { room, line } => {
                let [from, to] = line.map(|[x_m, y_m]| Point2 { x_m, y_m });
                Room(RoomEdit::Split {
                    room: *room,
                    line: CutLine::new(from, to).ok()?,
                })
            }
            Self::JoinRooms(rooms) => Room(RoomEdit::Join { rooms: *rooms }),
            Self::UndoRoomChange(number) => Room(RoomEdit::Undo { number: *number }),
            Self::MoveDock([x_m, y_m, heading_rad]) => MapEdit::Dock(Pose2 {
                x_m: *x_m,
                y_m: *y_m,
                heading_rad: *heading_rad,
            }),
        })
    }
}

/// `None` for a name that the brain would refuse.
fn to_name(name: Option<&str>) -> Option<Option<RoomName>> {
    name.map(RoomName::new).transpose().ok()
}

#[cfg(test)]
mod tests {
    use super::super::GivenCommand;

    /// As earlier versions wrote them, and as they are written now.
    const RECORDED: [(&str, &str); 17] = [
        (
            r#"{"add-no-go":{"zone":[[0.0,0.25],[0.5,0.0],[-1.0,2.0]]}}"#,
            r#"{"c":"add-no-go","shape":{"zone":[[0.0,0.25],[0.5,0.0],[-1.0,2.0]]}}"#,
        ),
        (
            r#"{"add-named-no-go":[{"wall":[[0.0,0.0],[1.0,0.5]]},"Cats"]}"#,
            r#"{"c":"add-no-go","shape":{"wall":[[0.0,0.0],[1.0,0.5]]},"name":"Cats"}"#,
        ),
        (r#"{"remove-no-go":7}"#, r#"{"c":"remove-no-go","number":7}"#),
        (
            r#"{"name-no-go":{"number":7,"name":"Bowl"}}"#,
            r#"{"c":"name-no-go","number":7,"name":"Bowl"}"#,
        ),
        (
            r#"{"reshape-no-go":{"number":7,"no_go":{"wall":[[0.0,0.0],[1.0,0.5]]}}}"#,
            r#"{"c":"reshape-no-go","number":7,"shape":{"wall":[[0.0,0.0],[1.0,0.5]]}}"#,
        ),
        (
            r#"{"keep-place":{"name":"Table","place":{"zone":[[0.0,0.25],[0.5,0.0],[-1.0,2.0]]}}}"#,
            r#"{"c":"keep-place","name":"Table","shape":{"zone":[[0.0,0.25],[0.5,0.0],[-1.0,2.0]]}}"#,
        ),
        (
            r#"{"keep-place":{"name":"Bowl","place":{"spot":[0.5,1.5]},"number":3}}"#,
            r#"{"c":"keep-place","name":"Bowl","shape":{"spot":[0.5,1.5]},"number":3}"#,
        ),
        (
            r#"{"name-place":{"number":3,"name":"Bowl"}}"#,
            r#"{"c":"name-place","number":3,"name":"Bowl"}"#,
        ),
        (
            r#"{"reshape-place":{"number":3,"place":{"spot":[0.5,1.5]}}}"#,
            r#"{"c":"reshape-place","number":3,"shape":{"spot":[0.5,1.5]}}"#,
        ),
        (r#"{"forget-place":3}"#, r#"{"c":"forget-place","number":3}"#),
        (
            r#"{"name-room":{"room":3,"name":null}}"#,
            r#"{"c":"name-room","room":3}"#,
        ),
        (
            r#"{"set-room":{"room":3,"settings":[2,30,100,0],"pattern":"contour"}}"#,
            r#"{"c":"set-room","room":3,"settings":{"passes":2,"power":{"suction":0.3,"main_brush":1.0,"side_brushes":0.0},"pattern":"contour"}}"#,
        ),
        (
            r#"{"set-room":{"room":3,"settings":null}}"#,
            r#"{"c":"set-room","room":3}"#,
        ),
        (
            r#"{"split-room":{"room":3,"line":[[0.0,0.0],[1.0,0.5]]}}"#,
            r#"{"c":"split-room","room":3,"line":[[0.0,0.0],[1.0,0.5]]}"#,
        ),
        (r#"{"join-rooms":[3,4]}"#, r#"{"c":"join-rooms","rooms":[3,4]}"#),
        (
            r#"{"undo-room-change":2}"#,
            r#"{"c":"undo-room-change","number":2}"#,
        ),
        (
            r#"{"move-dock":[0.30000000000000004,-0.3333333333333333,3.0]}"#,
            r#"{"c":"move-dock","x":0.30000000000000004,"y":-0.3333333333333333,"heading":3.0}"#,
        ),
    ];

    #[test]
    fn edits_of_earlier_versions_are_read_as_they_are_written_now() {
        for (earlier, present) in RECORDED {
            let [before, now] = [earlier, present].map(|text| {
                let given: GivenCommand = serde_json::from_str(text).expect("is read");
                given.to_brain().expect("a good one")
            });
            assert_eq!(before, now, "{earlier}");
            let written = serde_json::to_value(GivenCommand::from(&now)).expect("plain");
            let expected: serde_json::Value = serde_json::from_str(present).expect("is JSON");
            assert_eq!(written, expected);
        }
    }
}
