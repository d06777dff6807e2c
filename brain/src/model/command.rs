//! What people and schedules ask of the brain.

use super::cut_line::CutLine;
use super::geometry::Pose2;
use super::kept_place::{KeptPlace, PlaceShape};
use super::no_go::{NoGo, RoomName};
use super::order::CleaningOrder;
use super::room_settings::RoomSettings;

/// A request, already arbitrated (see `vthal-core`): at most one source speaks at a time.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Clean everything with the named strategy.
    Clean {
        /// Which.
        strategy: StrategyName,
    },
    /// Clean parts of a known home with `systematic`.
    CleanParts {
        /// Which, and how often.
        order: CleaningOrder,
    },
    /// Forbid floor of the home to all ways that are planned.
    AddNoGo {
        /// Where.
        no_go: NoGo,
    },
    /// Allow it again.
    RemoveNoGo {
        /// Its number in [`crate::mapping::Annotations`].
        number: u16,
    },
    /// Give a no-go zone or virtual wall a name, or take it away.
    NameNoGo {
        /// Its number in [`crate::mapping::Annotations`].
        number: u16,
        /// Its name.
        name: Option<RoomName>,
    },
    /// Let a no-go zone or virtual wall forbid other floor, under its number and name.
    ReshapeNoGo {
        /// Its number in [`crate::mapping::Annotations`].
        number: u16,
        /// Where it is from now on.
        no_go: NoGo,
    },
    /// Keep a zone or spot under a name.
    KeepPlace {
        /// Which.
        place: KeptPlace,
        /// The number that it had before it was forgotten.
        number: Option<u16>,
    },
    /// Give a kept place another name.
    NamePlace {
        /// Its number in [`crate::mapping::Annotations`].
        number: u16,
        /// Its name.
        name: RoomName,
    },
    /// Let a kept place be elsewhere, under its number and name.
    ReshapePlace {
        /// Its number in [`crate::mapping::Annotations`].
        number: u16,
        /// Where it is from now on.
        shape: PlaceShape,
    },
    /// Keep a place no longer.
    ForgetPlace {
        /// Its number.
        number: u16,
    },
    /// Give a room a name, or take it away.
    NameRoom {
        /// Identity of the room.
        room: u16,
        /// Its name.
        name: Option<RoomName>,
    },
    /// Say how a room is cleaned.
    SetRoom {
        /// Identity of the room.
        room: u16,
        /// How; `None` = as any other.
        settings: Option<RoomSettings>,
    },
    /// Cut a room in two.
    SplitRoom {
        /// Identity of the room; without one, the room in which the line is longest.
        room: Option<u16>,
        /// Where.
        line: CutLine,
    },
    /// Make two rooms one.
    JoinRooms {
        /// Their identities.
        rooms: [u16; 2],
    },
    /// Take a change of the rooms back.
    UndoRoomChange {
        /// Its number in [`crate::mapping::RoomChanges`].
        number: u16,
    },
    /// Say where the dock stands now. A robot that is on it stands there, too.
    MoveDock {
        /// Pose of a robot on it, by eye.
        pose: Pose2,
    },
    /// Clean a small disc around the present place.
    Spot,
    /// Stand still, keep the job.
    Pause,
    /// Go on with the paused job.
    Resume,
    /// End the job and stand still.
    Stop,
    /// Dock when the way leads there: finish now, drive on without cleaning until the dock is found, then stop.
    Dock,
    /// A person drives. Valid until `valid_until_us`.
    Manual {
        /// Forward speed.
        speed_m_per_s: f64,
        /// Turn rate.
        turn_rad_per_s: f64,
        /// Host time at which the lease ends.
        valid_until_us: u64,
        /// Brushes and suction run while driving.
        cleaners: bool,
    },
    /// The person lets go.
    ManualEnd,
    /// A person acknowledges an error whose cause is gone.
    ClearError,
}

/// Strategies that can be chosen by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum StrategyName {
    /// `bounce`: drive until a bump, back off, turn by a random angle. What the software of 2016 did.
    #[default]
    Bounce,
    /// `statistical`: bouncing towards floor that was not swept lately, along the walls to the next place. For robots that nothing
    /// but their wheels tells their heading.
    Statistical,
    /// `systematic`: lanes over a home whose map is known, with few turns.
    Systematic,
    /// `wall-bounce`: bouncing with stretches along the walls and spirals on open floor.
    WallBounce,
}

impl StrategyName {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::Bounce,
        Self::Statistical,
        Self::Systematic,
        Self::WallBounce,
    ];

    /// The name people type.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bounce => "bounce",
            Self::Statistical => "statistical",
            Self::Systematic => "systematic",
            Self::WallBounce => "wall-bounce",
        }
    }

    /// The strategy with exactly this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|strategy| strategy.name() == name)
    }
}
