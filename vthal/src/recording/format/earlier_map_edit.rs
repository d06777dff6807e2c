//! Edits of the map in recordings of earlier versions. New recordings keep them as clients ask for them, so nothing is added here.

use rvac_api::{
    CleaningPattern, CleaningPower, NoGoShape, PlaceShape, RequestBody, RoomNaming, RoomSettings,
    RoomSplitting,
};
use serde::{Deserialize, Serialize};

/// [`brain::MapEdit`]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EarlierMapEdit {
    /// [`brain::NoGoEdit::Add`]
    AddNoGo(NoGoShape),
    /// [`brain::NoGoEdit::Add`] of one that has a name.
    AddNamedNoGo(NoGoShape, String),
    /// [`brain::NoGoEdit::Remove`] by its number.
    RemoveNoGo(u16),
    /// [`brain::NoGoEdit::Name`]
    NameNoGo {
        /// Its number.
        number: u16,
        /// Its name; absent = none any more.
        name: Option<String>,
    },
    /// [`brain::NoGoEdit::Reshape`]
    ReshapeNoGo {
        /// Its number.
        number: u16,
        /// Where it is from now on.
        no_go: NoGoShape,
    },
    /// [`brain::PlaceEdit::Keep`]
    KeepPlace {
        /// Its name.
        name: String,
        /// Where.
        place: PlaceShape,
        /// The number that it had.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        number: Option<u16>,
    },
    /// [`brain::PlaceEdit::Name`]
    NamePlace {
        /// Its number.
        number: u16,
        /// Its name.
        name: String,
    },
    /// [`brain::PlaceEdit::Reshape`]
    ReshapePlace {
        /// Its number.
        number: u16,
        /// Where it is from now on.
        place: PlaceShape,
    },
    /// [`brain::PlaceEdit::Forget`] by its number.
    ForgetPlace(u16),
    /// [`brain::RoomEdit::Name`]
    NameRoom {
        /// Identity of the room.
        room: u16,
        /// Its name; absent = none any more.
        name: Option<String>,
    },
    /// [`brain::RoomEdit::Set`]
    SetRoom {
        /// Identity of the room.
        room: u16,
        /// Passes, then percent of suction, main brush and side brushes; absent = as any other.
        settings: Option<[u8; 4]>,
        /// Absent = lines.
        #[serde(default, skip_serializing_if = "CleaningPattern::is_usual")]
        pattern: CleaningPattern,
    },
    /// [`brain::RoomEdit::Split`]
    SplitRoom {
        /// Identity of the room.
        room: Option<u16>,
        /// The ends of the line.
        line: [[f64; 2]; 2],
    },
    /// [`brain::RoomEdit::Join`] by their identities.
    JoinRooms([u16; 2]),
    /// [`brain::RoomEdit::Undo`] by its number.
    UndoRoomChange(u16),
    /// [`brain::MapEdit::Dock`]: position and heading of a robot on it.
    MoveDock([f64; 3]),
}

impl EarlierMapEdit {
    /// The same edit as clients ask for it on the socket.
    pub(super) fn to_request(&self) -> RequestBody {
        match self.clone() {
            Self::AddNoGo(shape) => RequestBody::AddNoGo { shape, name: None },
            Self::AddNamedNoGo(shape, name) => RequestBody::AddNoGo {
                shape,
                name: Some(name),
            },
            Self::RemoveNoGo(number) => RequestBody::RemoveNoGo { number },
            Self::NameNoGo { number, name } => RequestBody::NameNoGo { number, name },
            Self::ReshapeNoGo { number, no_go } => RequestBody::ReshapeNoGo {
                number,
                shape: no_go,
                was: None,
            },
            Self::KeepPlace { name, place, number } => RequestBody::KeepPlace {
                name,
                shape: place,
                number,
            },
            Self::NamePlace { number, name } => RequestBody::NamePlace { number, name },
            Self::ReshapePlace { number, place } => RequestBody::ReshapePlace {
                number,
                shape: place,
                was: None,
            },
            Self::ForgetPlace(number) => RequestBody::ForgetPlace { number },
            Self::NameRoom { room, name } => RequestBody::NameRoom(RoomNaming { room, name }),
            Self::SetRoom {
                room,
                settings,
                pattern,
            } => RequestBody::SetRoom {
                room,
                settings: settings.map(|settings| with_shares(settings, pattern)),
                was: None,
            },
            Self::SplitRoom { room, line } => RequestBody::SplitRoom(RoomSplitting { room, line }),
            Self::JoinRooms(rooms) => RequestBody::JoinRooms { rooms },
            Self::UndoRoomChange(number) => RequestBody::UndoRoomChange { number },
            Self::MoveDock([x, y, heading]) => RequestBody::MoveDock { x, y, heading },
        }
    }
}

/// Clients send shares in place of percent.
fn with_shares([passes, power @ ..]: [u8; 4], pattern: CleaningPattern) -> RoomSettings {
    let [suction, main_brush, side_brushes] = power.map(|percent| f64::from(percent) / 100.0);
    RoomSettings {
        passes,
        power: CleaningPower {
            suction,
            main_brush,
            side_brushes,
        },
        pattern,
    }
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
