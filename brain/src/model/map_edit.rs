//! What people change of the map of a home.

use super::cut_line::CutLine;
use super::geometry::Pose2;
use super::kept_place::{KeptPlace, PlaceShape};
use super::no_go::{NoGo, RoomName};
use super::room_settings::RoomSettings;

/// A change of the map. [`crate::mapping::Map::admit`] says whether it can be made, [`crate::mapping::Map::apply`] makes it.
#[derive(Clone, Debug, PartialEq)]
pub enum MapEdit {
    /// A no-go zone or virtual wall.
    NoGo(NoGoEdit),
    /// A zone or spot that is kept under a name.
    Place(PlaceEdit),
    /// The rooms.
    Room(RoomEdit),
    /// The dock is elsewhere: the pose of a robot on it, by eye. A robot that is on it was carried along.
    Dock(Pose2),
}

impl MapEdit {
    /// Whether it can be made only while the robot rests: each change of the division segments the rooms anew, and a job keeps the rooms
    /// and the dock that it started with.
    #[must_use]
    pub const fn needs_rest(&self) -> bool {
        match self {
            Self::NoGo(_) | Self::Place(_) => false,
            Self::Room(edit) => match edit {
                RoomEdit::Name { .. } | RoomEdit::Set { .. } => false,
                RoomEdit::Split { .. } | RoomEdit::Join { .. } | RoomEdit::Undo { .. } => true,
            },
            Self::Dock(_) => true,
        }
    }
}

/// A change of the no-go zones and virtual walls. They have the numbers of [`crate::mapping::Annotations`].
#[derive(Clone, Debug, PartialEq)]
pub enum NoGoEdit {
    /// Forbids floor to all planned paths.
    Add(NoGo),
    /// Allows it again.
    Remove {
        /// Its number.
        number: u16,
    },
    /// Names it, or takes its name away.
    Name {
        /// Its number.
        number: u16,
        /// Its name.
        name: Option<RoomName>,
    },
    /// Forbids other floor under its number and name.
    Reshape {
        /// Its number.
        number: u16,
        /// Where it is from now on.
        no_go: NoGo,
    },
}

/// A change of the kept places. They have the numbers of [`crate::mapping::Annotations`].
#[derive(Clone, Debug, PartialEq)]
pub enum PlaceEdit {
    /// Keeps a zone or spot under a name.
    Keep {
        /// Which.
        place: KeptPlace,
        /// The number that it had before it was removed; `None` = a new one.
        number: Option<u16>,
    },
    /// Gives it another name.
    Name {
        /// Its number.
        number: u16,
        /// Its name.
        name: RoomName,
    },
    /// Moves or reshapes it, under its number and name.
    Reshape {
        /// Its number.
        number: u16,
        /// Where it is from now on.
        shape: PlaceShape,
    },
    /// Keeps it no longer.
    Forget {
        /// Its number.
        number: u16,
    },
}

/// A change of the rooms.
#[derive(Clone, Debug, PartialEq)]
pub enum RoomEdit {
    /// Names a room, or takes its name away.
    Name {
        /// Identity of the room.
        room: u16,
        /// Its name.
        name: Option<RoomName>,
    },
    /// Says how a room is cleaned.
    Set {
        /// Identity of the room.
        room: u16,
        /// How; `None` = as any other.
        settings: Option<RoomSettings>,
    },
    /// Cuts a room in two.
    Split {
        /// Identity of the room; without one, the room in which the line is longest.
        room: Option<u16>,
        /// Where.
        line: CutLine,
    },
    /// Makes two rooms one.
    Join {
        /// Their identities.
        rooms: [u16; 2],
    },
    /// Reverts a change of the rooms.
    Undo {
        /// Its number in [`crate::mapping::RoomChanges`].
        number: u16,
    },
}
