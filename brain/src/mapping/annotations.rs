//! Annotations by people: no-go zones, changes and names of rooms, room settings, and saved zones and spots.

use std::collections::BTreeMap;

use super::next_numbers::NextNumbers;
use super::room_changes::RoomChanges;
use crate::model::edit_error::EditError;
use crate::model::kept_place::KeptPlace;
use crate::model::no_go::{NoGo, RoomName};
use crate::model::room_settings::RoomSettings;

/// Most no-go zones and virtual walls of a home.
pub(super) const NO_GO_MAX: usize = 64;
/// Most saved zones and spots.
pub(super) const PLACES_MAX: usize = 64;
/// Most names of rooms, including those of rooms that no longer exist.
pub(super) const NAMES_MAX: usize = 1_000;

/// Everything that people added to the map.
#[derive(Clone, Debug, PartialEq)]
pub struct Annotations {
    pub(super) no_go: BTreeMap<u16, NoGo>,
    /// Next number; numbers are never reused.
    pub(super) next_no_go: u16,
    pub(super) names: BTreeMap<u16, RoomName>,
    pub(super) rooms: RoomChanges,
    pub(super) settings: BTreeMap<u16, RoomSettings>,
    pub(super) places: KeptPlaces,
}

/// Saved zones and spots.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct KeptPlaces {
    pub(super) kept: BTreeMap<u16, KeptPlace>,
    /// Next number. A number is only reused to restore what it belonged to.
    pub(super) next: u16,
}

impl Default for KeptPlaces {
    fn default() -> Self {
        Self {
            kept: BTreeMap::new(),
            next: 1,
        }
    }
}

impl KeptPlaces {
    /// Two places of one name could not be told apart; a new one has no number yet.
    pub(super) fn may_be_called(&self, number: Option<u16>, name: &RoomName) -> Result<(), EditError> {
        let mut others = self.kept.iter().filter(|(other, _)| Some(**other) != number);
        if others.any(|(_, place)| place.name().sounds_like(name.as_str())) {
            return Err(EditError::NameTaken);
        }
        Ok(())
    }
}

impl Default for Annotations {
    fn default() -> Self {
        Self {
            no_go: BTreeMap::new(),
            next_no_go: 1,
            names: BTreeMap::new(),
            rooms: RoomChanges::default(),
            settings: BTreeMap::new(),
            places: KeptPlaces::default(),
        }
    }
}

impl Annotations {
    /// No-go zones and virtual walls by their numbers, from 1.
    pub fn no_go(&self) -> impl Iterator<Item = (u16, &NoGo)> {
        self.no_go.iter().map(|(number, no_go)| (*number, no_go))
    }

    /// Name of a room, if it has one.
    #[must_use]
    pub fn name(&self, room: u16) -> Option<&RoomName> {
        self.names.get(&room)
    }

    /// Splits and joins of the segmented rooms.
    #[must_use]
    pub fn room_changes(&self) -> &RoomChanges {
        &self.rooms
    }

    /// Settings of a room, if it has any.
    #[must_use]
    pub fn settings(&self, room: u16) -> Option<&RoomSettings> {
        self.settings.get(&room)
    }

    /// Saved zones and spots by their numbers, from 1.
    pub fn places(&self) -> impl Iterator<Item = (u16, &KeptPlace)> {
        self.places.kept.iter().map(|(number, place)| (*number, place))
    }

    /// The saved place with a number.
    #[must_use]
    pub fn place(&self, number: u16) -> Option<&KeptPlace> {
        self.places.kept.get(&number)
    }

    /// Rooms whose settings satisfy a condition.
    pub(crate) fn rooms_with(&self, is_like: impl Fn(&RoomSettings) -> bool) -> impl Iterator<Item = u16> {
        let settings = self.settings.iter();
        settings
            .filter(move |(_, settings)| is_like(settings))
            .map(|(room, _)| *room)
    }

    /// Whether there are no annotations.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        let says_nothing_of_rooms =
            self.names.is_empty() && self.rooms.is_empty() && self.settings.is_empty();
        says_nothing_of_rooms && self.no_go.is_empty() && self.places.kept.is_empty()
    }

    /// The numbers of new items; rooms are not among them.
    pub(super) fn next_numbers(&self) -> NextNumbers {
        NextNumbers {
            room_change: self.rooms.next,
            no_go: self.next_no_go,
            place: self.places.next,
            ..NextNumbers::default()
        }
    }

    /// New items get these numbers or higher ones.
    pub(super) fn number_after(&mut self, next: NextNumbers) {
        self.next_no_go = self.next_no_go.max(next.no_go);
        self.rooms.next = self.rooms.next.max(next.room_change);
        self.places.next = self.places.next.max(next.place);
    }

    pub(super) fn add(&mut self, no_go: NoGo) -> Result<(), EditError> {
        self.has_room_for_another()?;
        let number = self.next_no_go;
        self.next_no_go = number.checked_add(1).ok_or(EditError::TooManyNoGos)?;
        self.no_go.insert(number, no_go);
        Ok(())
    }

    pub(super) fn has_room_for_another(&self) -> Result<(), EditError> {
        if self.no_go.len() < NO_GO_MAX && self.next_no_go < u16::MAX {
            Ok(())
        } else {
            Err(EditError::TooManyNoGos)
        }
    }

    /// Two no-go zones of one name could not be told apart; a new one has no number yet.
    pub(super) fn may_forbid_as(&self, number: Option<u16>, name: &RoomName) -> Result<(), EditError> {
        let sounds_like = |no_go: &NoGo| no_go.name().is_some_and(|taken| taken.sounds_like(name.as_str()));
        let mut others = self.no_go.iter().filter(|(other, _)| Some(**other) != number);
        if others.any(|(_, no_go)| sounds_like(no_go)) {
            return Err(EditError::NameTaken);
        }
        Ok(())
    }

    /// Two rooms of one name could not be told apart. One that a change of people hides has none.
    pub(super) fn may_be_called(&self, room: u16, name: &RoomName) -> Result<(), EditError> {
        let is_taken = |(other, taken): (&u16, &RoomName)| {
            *other != room && taken.sounds_like(name.as_str()) && !self.rooms.hides(*other)
        };
        if self.names.iter().any(is_taken) {
            return Err(EditError::NameTaken);
        }
        if self.names.len() >= NAMES_MAX && !self.names.contains_key(&room) {
            return Err(EditError::BadName);
        }
        Ok(())
    }

    pub(super) fn call(&mut self, room: u16, name: Option<RoomName>) {
        match name {
            Some(name) => {
                let is_its_own =
                    |other: &u16, taken: &RoomName| *other == room || !taken.sounds_like(name.as_str());
                self.names.retain(|other, taken| is_its_own(other, taken));
                self.names.insert(room, name)
            }
            None => self.names.remove(&room),
        };
    }
}
