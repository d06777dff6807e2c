//! The plain parts of a stored map, for serialization.

use core::fmt;
use std::collections::{BTreeMap, BTreeSet};

use super::{CELLS_MAX, CellRun, SURFACE_BITS, StoredMap};
use crate::mapping::annotations::{KeptPlaces, NAMES_MAX, NO_GO_MAX, PLACES_MAX};
use crate::mapping::cell_past::CellPast;
use crate::mapping::dock_location::MeasuredDock;
use crate::mapping::room_changes::CHANGES_MAX;
use crate::mapping::{Annotations, Cell, DockLocation, RoomChange, RoomChanges, RoomSplit};
use crate::model::geometry::Pose2;
use crate::model::kept_place::KeptPlace;
use crate::model::known_beacon::{KNOWN_BEACONS_MAX, KnownBeacon};
use crate::model::no_go::{NoGo, RoomName};
use crate::model::room_settings::RoomSettings;

/// Everything that a stored map holds. [`StoredMap::from_parts`] checks it.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredMapParts {
    /// Location of the dock as measured by docking.
    pub measured_dock: Option<MeasuredDock>,
    /// Location of the dock as a person reported it.
    pub reported_dock: Option<Pose2>,
    /// Lowest cell of the map.
    pub origin: Cell,
    /// Columns of the map.
    pub width: u32,
    /// Rows of the map.
    pub height: u32,
    /// Packed evidence of each cell, row by row; empty when all cells are unknown.
    pub cells: Vec<CellRun>,
    /// Room of each cell, 0 = none; empty when the map has no rooms yet.
    pub rooms: Vec<CellRun>,
    /// What earlier runs found in each cell, packed; empty when nothing is known of earlier runs.
    pub past: Vec<CellRun>,
    /// Identity of the next new room.
    pub next_room: u16,
    /// No-go zones and virtual walls.
    pub no_go: Numbered<NoGo>,
    /// Names of rooms.
    pub names: BTreeMap<u16, RoomName>,
    /// Splits and joins of rooms.
    pub room_changes: Numbered<RoomChange>,
    /// Undone splits that keep their identities.
    pub undone_splits: Vec<RoomSplit>,
    /// Settings of rooms.
    pub room_settings: BTreeMap<u16, RoomSettings>,
    /// Saved zones and spots.
    pub places: Numbered<KeptPlace>,
    /// Radio beacons.
    pub beacons: Vec<KnownBeacon>,
}

/// Items with numbers that are never reused.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbered<T> {
    /// Next number.
    pub next: u16,
    /// All items.
    pub items: Vec<(u16, T)>,
}

/// Why parts are not a valid map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoredMapError {
    /// Too many cells.
    TooLarge {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The runs of a layer have a wrong number of cells.
    Cells {
        /// Number of cells in the map.
        expected: u64,
        /// Number of cells in the layer.
        found: u64,
    },
    /// Unknown surface.
    Surface,
    /// Unknown past of a cell.
    Past,
    /// Invalid no-go zone, or too many.
    NoGo,
    /// Invalid saved place, or too many.
    Place,
    /// Invalid room name, or too many.
    Name,
    /// Invalid change of rooms, or too many.
    RoomChange,
    /// Invalid room settings, or too many.
    RoomSettings,
    /// A radio beacon that cannot be, twice the same, or too many.
    Beacon,
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
            Self::Surface => formatter.write_str("it has a kind of floor that cannot be"),
            Self::Past => formatter.write_str("it has a past of a cell that cannot be"),
            Self::NoGo => formatter.write_str("it has a no-go zone that cannot be"),
            Self::Name => formatter.write_str("it has a name of a room that cannot be"),
            Self::Place => formatter.write_str("it keeps a place that cannot be"),
            Self::RoomChange => formatter.write_str("it has a change of rooms that cannot be"),
            Self::RoomSettings => formatter.write_str("it has settings of a room that cannot be"),
            Self::Beacon => formatter.write_str("it has a radio beacon that cannot be"),
        }
    }
}

impl core::error::Error for StoredMapError {}

impl StoredMap {
    /// A copy of all parts.
    #[must_use]
    pub fn parts(&self) -> StoredMapParts {
        let words = &self.annotations;
        StoredMapParts {
            measured_dock: self.dock.measured(),
            reported_dock: self.dock.reported(),
            origin: self.origin,
            width: self.width,
            height: self.height,
            cells: self.cells.clone(),
            rooms: self.rooms.clone(),
            past: self.past.clone(),
            next_room: self.next_room,
            no_go: Numbered::of(words.next_no_go, &words.no_go),
            names: words.names.clone(),
            room_changes: Numbered::of(words.rooms.next, &words.rooms.made),
            undone_splits: words.rooms.undone.clone(),
            room_settings: words.settings.clone(),
            places: Numbered::of(words.places.next, &words.places.kept),
            beacons: self.beacons.clone(),
        }
    }

    /// Builds a map of parts.
    ///
    /// # Errors
    /// The first part that is not valid.
    pub fn from_parts(parts: StoredMapParts) -> Result<Self, StoredMapError> {
        parts.check_layers()?;
        parts.check_room_changes()?;
        parts.check_beacons()?;
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
            undone: parts.undone_splits,
        };
        let places = KeptPlaces {
            next: parts.places.next,
            kept: parts.places.checked(PLACES_MAX, StoredMapError::Place)?,
        };
        Ok(Self {
            dock: DockLocation::from_parts(parts.measured_dock, parts.reported_dock),
            origin: parts.origin,
            width: parts.width,
            height: parts.height,
            cells: parts.cells,
            rooms: parts.rooms,
            past: parts.past,
            next_room: parts.next_room,
            annotations: Annotations {
                no_go: parts.no_go.checked(NO_GO_MAX, StoredMapError::NoGo)?,
                next_no_go,
                names: parts.names,
                rooms,
                settings: parts.room_settings,
                places,
            },
            beacons: parts.beacons,
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

    /// The items by number, if there are not too many and each has a unique number that was given.
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
        for layer in [&self.cells, &self.rooms, &self.past] {
            // Fewer than 2^32 runs of fewer than 2^32 cells.
            let found = layer.iter().map(|run| u64::from(run.length)).sum();
            if !layer.is_empty() && found != expected {
                return Err(StoredMapError::Cells { expected, found });
            }
        }
        let has_known_floor = |run: &CellRun| run.value & SURFACE_BITS != SURFACE_BITS;
        if !self.cells.iter().all(has_known_floor) {
            return Err(StoredMapError::Surface);
        }
        let is_past = |run: &CellRun| run.value & !CellPast::BITS == 0;
        let are_pasts = self.past.iter().all(is_past);
        are_pasts.then_some(()).ok_or(StoredMapError::Past)
    }

    fn check_beacons(&self) -> Result<(), StoredMapError> {
        let numbers: BTreeSet<u16> = self.beacons.iter().map(|beacon| beacon.number).collect();
        let are_good = self.beacons.len() <= KNOWN_BEACONS_MAX
            && numbers.len() == self.beacons.len()
            && self.beacons.iter().all(KnownBeacon::is_possible);
        are_good.then_some(()).ok_or(StoredMapError::Beacon)
    }

    /// Each change must name two different existing rooms.
    fn check_room_changes(&self) -> Result<(), StoredMapError> {
        let known = 1..self.next_room;
        let is_good = |[one, other]: [u16; 2]| one != other && known.contains(&one) && known.contains(&other);
        let mut made = self.room_changes.items.iter().map(|(_, change)| change.rooms());
        let mut undone = self.undone_splits.iter().map(|split| [split.room, split.part]);
        let are_good = self.undone_splits.len() <= CHANGES_MAX && made.all(is_good) && undone.all(is_good);
        are_good.then_some(()).ok_or(StoredMapError::RoomChange)
    }
}
