//! Plain parts of a stored map, for what makes bytes of it and what reads them.

use core::fmt;
use std::collections::BTreeMap;

use super::{CELLS_MAX, FLOOR_BITS, Run, StoredMap};
use crate::mapping::annotations::{KeptPlaces, NAMES_MAX, NO_GO_MAX, PLACES_MAX};
use crate::mapping::dock::Felt;
use crate::mapping::room_changes::CHANGES_MAX;
use crate::mapping::{Annotations, Cell, DockPlace, RoomChange, RoomChanges, RoomSplit};
use crate::model::geometry::Pose2;
use crate::model::kept_place::KeptPlace;
use crate::model::no_go::{NoGo, RoomName};
use crate::model::room_settings::RoomSettings;

/// Everything that a stored map holds. [`StoredMap::from_parts`] checks it.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredMapParts {
    /// Where the dock was felt.
    pub felt_dock: Option<Felt>,
    /// Where a person says that it stands.
    pub told_dock: Option<Pose2>,
    /// Lowest cell of the window.
    pub origin: Cell,
    /// Columns of the window.
    pub width: u32,
    /// Rows of the window.
    pub height: u32,
    /// What each cell holds, row by row; no runs at all when nothing is known.
    pub cells: Vec<Run>,
    /// Room of each cell, 0 = none; no runs at all when the map has no rooms yet.
    pub rooms: Vec<Run>,
    /// Identity of the next room that has none yet.
    pub next_room: u16,
    /// No-go zones and virtual walls.
    pub no_go: Numbered<NoGo>,
    /// Names of rooms.
    pub names: BTreeMap<u16, RoomName>,
    /// How people changed the rooms.
    pub room_changes: Numbered<RoomChange>,
    /// Splits that were taken back and keep their identities.
    pub splits_taken_back: Vec<RoomSplit>,
    /// How rooms are cleaned.
    pub room_settings: BTreeMap<u16, RoomSettings>,
    /// Zones and spots that are kept.
    pub places: Numbered<KeptPlace>,
}

/// Things with numbers that are given once.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbered<T> {
    /// Number of the next one.
    pub next: u16,
    /// All that there are.
    pub items: Vec<(u16, T)>,
}

/// Why parts make no map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoredMapError {
    /// More cells than a map can have.
    TooLarge {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// A layer has another number of cells than the window.
    Cells {
        /// Of the window.
        expected: u64,
        /// Of the layer.
        found: u64,
    },
    /// A kind of floor that is not known here.
    Floor,
    /// A no-go zone that no map can have, or too many.
    NoGo,
    /// A place that no map can keep, or too many.
    Place,
    /// A name that no room can have, or too many.
    Name,
    /// A change of rooms that no map can have, or too many.
    RoomChange,
    /// Settings that no room can have, or too many.
    RoomSettings,
}

impl fmt::Display for StoredMapError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge { width, height } => {
                write!(
                    formatter,
                    "{width} times {height} cells are more than a map can have"
                )
            }
            Self::Cells { expected, found } => {
                write!(formatter, "a layer has {found} cells instead of {expected}")
            }
            Self::Floor => formatter.write_str("it has a kind of floor that cannot be"),
            Self::NoGo => formatter.write_str("it has a no-go zone that cannot be"),
            Self::Name => formatter.write_str("it has a name of a room that cannot be"),
            Self::Place => formatter.write_str("it keeps a place that cannot be"),
            Self::RoomChange => formatter.write_str("it has a change of rooms that cannot be"),
            Self::RoomSettings => formatter.write_str("it has settings of a room that cannot be"),
        }
    }
}

impl core::error::Error for StoredMapError {}

impl StoredMap {
    /// Takes a copy of it apart.
    #[must_use]
    pub fn parts(&self) -> StoredMapParts {
        let words = &self.annotations;
        StoredMapParts {
            felt_dock: self.dock.felt(),
            told_dock: self.dock.told(),
            origin: self.origin,
            width: self.width,
            height: self.height,
            cells: self.cells.clone(),
            rooms: self.rooms.clone(),
            next_room: self.next_room,
            no_go: Numbered::of(words.next_no_go, &words.no_go),
            names: words.names.clone(),
            room_changes: Numbered::of(words.rooms.next, &words.rooms.made),
            splits_taken_back: words.rooms.taken_back.clone(),
            room_settings: words.settings.clone(),
            places: Numbered::of(words.places.next, &words.places.kept),
        }
    }

    /// The map of these parts.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn from_parts(parts: StoredMapParts) -> Result<Self, StoredMapError> {
        parts.check_layers()?;
        parts.check_room_changes()?;
        if parts.names.len() > NAMES_MAX {
            return Err(StoredMapError::Name);
        }
        if parts.room_settings.len() > NAMES_MAX {
            return Err(StoredMapError::RoomSettings);
        }
        let next_no_go = parts.no_go.next;
        let rooms = RoomChanges {
            next: parts.room_changes.next,
            made: parts
                .room_changes
                .checked(CHANGES_MAX, StoredMapError::RoomChange)?,
            taken_back: parts.splits_taken_back,
        };
        let places = KeptPlaces {
            next: parts.places.next,
            kept: parts.places.checked(PLACES_MAX, StoredMapError::Place)?,
        };
        Ok(Self {
            dock: DockPlace::from_parts(parts.felt_dock, parts.told_dock),
            origin: parts.origin,
            width: parts.width,
            height: parts.height,
            cells: parts.cells,
            rooms: parts.rooms,
            next_room: parts.next_room,
            annotations: Annotations {
                no_go: parts.no_go.checked(NO_GO_MAX, StoredMapError::NoGo)?,
                next_no_go,
                names: parts.names,
                rooms,
                settings: parts.room_settings,
                places,
            },
        })
    }
}

impl<T: Clone> Numbered<T> {
    fn of(next: u16, items: &BTreeMap<u16, T>) -> Self {
        let items = items.iter().map(|(number, item)| (*number, item.clone()));
        Self {
            next,
            items: items.collect(),
        }
    }

    /// By their numbers, if there are at most so many and each number was given, and once.
    fn checked(self, most: usize, error: StoredMapError) -> Result<BTreeMap<u16, T>, StoredMapError> {
        let count = self.items.len();
        let checked: BTreeMap<u16, T> = self.items.into_iter().collect();
        let was_given = |number: &u16| *number < self.next;
        let is_good = count <= most && checked.len() == count && checked.keys().all(was_given);
        is_good.then_some(checked).ok_or(error)
    }
}

impl StoredMapParts {
    fn check_layers(&self) -> Result<(), StoredMapError> {
        let (width, height) = (self.width, self.height);
        let expected = u64::from(width) * u64::from(height);
        if expected > CELLS_MAX {
            return Err(StoredMapError::TooLarge { width, height });
        }
        for layer in [&self.cells, &self.rooms] {
            // Fewer than 2^32 runs of fewer than 2^32 cells.
            let found = layer.iter().map(|run| u64::from(run.length)).sum();
            if !layer.is_empty() && found != expected {
                return Err(StoredMapError::Cells { expected, found });
            }
        }
        let has_known_floor = |run: &Run| run.value & FLOOR_BITS != FLOOR_BITS;
        let is_known = self.cells.iter().all(has_known_floor);
        is_known.then_some(()).ok_or(StoredMapError::Floor)
    }

    /// Each change speaks of two rooms that the map has given an identity.
    fn check_room_changes(&self) -> Result<(), StoredMapError> {
        let known = 1..self.next_room;
        let is_good = |[one, other]: [u16; 2]| one != other && known.contains(&one) && known.contains(&other);
        let mut made = self.room_changes.items.iter().map(|(_, change)| change.rooms());
        let mut taken_back = self
            .splits_taken_back
            .iter()
            .map(|split| [split.room, split.part]);
        let are_good =
            self.splits_taken_back.len() <= CHANGES_MAX && made.all(is_good) && taken_back.all(is_good);
        are_good.then_some(()).ok_or(StoredMapError::RoomChange)
    }
}
