//! What people change of the rooms that are found: a room is cut in two along a line, or two rooms are one.
//!
//! Changes are kept in the order in which they were made, with the identities that they gave. Whenever rooms are looked for
//! again, the changes are made again in what was found; so they hold in a map that was drawn anew, and taking one back brings
//! the rooms and identities that were there before it.

use std::collections::BTreeMap;

use super::room_cut::{PartSide, nearest_cut};
use super::{Cell, Raster};
use crate::model::cut_line::CutLine;
use crate::model::edit_error::EditError;
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;

/// Most changes of a home's rooms, and most splits that were taken back and may be made again under their identities.
pub(super) const CHANGES_MAX: usize = 64;
/// Work on a cell that is looked at.
const CELL_WORK: usize = 2;

/// A change of the rooms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RoomChange {
    /// A room was cut in two.
    Split(RoomSplit),
    /// Two rooms are one.
    Join(RoomJoin),
}

/// A room that was cut in two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoomSplit {
    /// The room, which keeps its identity with its larger part.
    pub room: u16,
    /// Identity of the other part.
    pub part: u16,
    /// Where that one lies, seen along the line.
    pub side: PartSide,
    /// As the person drew it.
    pub line: CutLine,
}

/// Two rooms that are one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoomJoin {
    /// Identity of both now.
    pub kept: u16,
    /// Identity of the other one before.
    pub lost: u16,
    /// A place in the middle of each, in case they are found under other identities one day.
    pub at: [Point2; 2],
}

impl RoomChange {
    /// Identities that mean something else without it.
    pub(super) fn rooms(&self) -> [u16; 2] {
        match self {
            Self::Split(split) => [split.room, split.part],
            Self::Join(join) => [join.kept, join.lost],
        }
    }
}

/// All changes of the rooms of a home.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomChanges {
    pub(super) made: BTreeMap<u16, RoomChange>,
    /// Number of the next one; numbers are not used twice.
    pub(super) next: u16,
    /// Splits that were taken back: made again, they give the same identity.
    pub(super) taken_back: Vec<RoomSplit>,
}

impl Default for RoomChanges {
    fn default() -> Self {
        Self {
            made: BTreeMap::new(),
            next: 1,
            taken_back: Vec::new(),
        }
    }
}

impl RoomChanges {
    /// All of them by their numbers, which are from 1, in the order in which they were made.
    pub fn made(&self) -> impl Iterator<Item = (u16, &RoomChange)> {
        self.made.iter().map(|(number, change)| (*number, change))
    }

    /// Whether nobody has changed anything.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.made.is_empty()
    }

    /// Whether a room is not there only because of a change, or because one was taken back.
    pub(super) fn hide(&self, room: u16) -> bool {
        let is_joined = |change: &RoomChange| matches!(change, RoomChange::Join(join) if join.lost == room);
        self.made.values().any(is_joined) || self.taken_back.iter().any(|split| split.part == room)
    }

    /// The number of the change that a later one builds on it, if one does.
    #[must_use]
    pub fn built_on(&self, number: u16) -> Option<u16> {
        let rooms = self.made.get(&number)?.rooms();
        let mut later = self.made.iter().rev().take_while(|(other, _)| **other > number);
        later
            .find(|(_, change)| change.rooms().iter().any(|room| rooms.contains(room)))
            .map(|(other, _)| *other)
    }

    pub(super) fn has_room_for_another(&self) -> Result<(), EditError> {
        if self.made.len() < CHANGES_MAX && self.next < u16::MAX {
            Ok(())
        } else {
            Err(EditError::TooManyRoomChanges)
        }
    }

    pub(super) fn add(&mut self, change: RoomChange) -> Result<(), EditError> {
        self.has_room_for_another()?;
        if let RoomChange::Split(split) = &change {
            self.taken_back.retain(|before| before.part != split.part);
        }
        self.made.insert(self.next, change);
        self.next = self.next.saturating_add(1);
        Ok(())
    }

    /// Identity that the same split had before it was taken back.
    pub(super) fn part_before(&self, (room, side, line): (u16, PartSide, CutLine)) -> Option<u16> {
        let is_same = |split: &&RoomSplit| (split.room, split.side, split.line) == (room, side, line);
        self.taken_back.iter().rev().find(is_same).map(|split| split.part)
    }

    pub(super) fn may_be_taken_back(&self, number: u16) -> Result<(), EditError> {
        if !self.made.contains_key(&number) {
            return Err(EditError::NoSuchRoomChange);
        }
        match self.built_on(number) {
            Some(_) => Err(EditError::RoomChangeInUse),
            None => Ok(()),
        }
    }

    pub(super) fn take_back(&mut self, number: u16) -> Result<(), EditError> {
        self.may_be_taken_back(number)?;
        if let Some(RoomChange::Split(split)) = self.made.remove(&number) {
            if self.taken_back.len() >= CHANGES_MAX {
                self.taken_back.remove(0);
            }
            self.taken_back.push(split);
        }
        Ok(())
    }

    /// The rooms that are found, with all changes made in them. Every cell of a room stays in a room.
    pub(super) async fn made_in(&self, found: &Raster<u16>, budget: &mut StepBudget) -> Raster<u16> {
        let mut labels = found.clone();
        for change in self.made.values() {
            match change {
                RoomChange::Split(split) => split.make(&mut labels, budget).await,
                RoomChange::Join(join) => join.make(&mut labels, budget).await,
            }
        }
        labels
    }
}

impl RoomSplit {
    /// Cuts its room, or the one under its line if that has another identity now. A line that does not reach from border to
    /// border any more divides what is nearest to its sides; one that misses all rooms waits until there is one again.
    async fn make(&self, labels: &mut Raster<u16>, budget: &mut StepBudget) {
        budget.spend(CELL_WORK * labels.values().len()).await;
        let cut = nearest_cut(labels, Some(self.room), &self.line)
            .or_else(|| nearest_cut(labels, None, &self.line));
        for cell in cut.iter().flat_map(|cut| cut.side(self.side)) {
            if let Some(label) = labels.get_mut(*cell) {
                *label = self.part;
            }
        }
    }
}

impl RoomJoin {
    async fn make(&self, labels: &mut Raster<u16>, budget: &mut StepBudget) {
        budget.spend(CELL_WORK * labels.values().len()).await;
        let now = [(self.kept, self.at[0]), (self.lost, self.at[1])].map(|(room, at)| {
            let is_there = labels.values().contains(&room);
            let there = labels.get(Cell::under(at)).copied().unwrap_or(0);
            if is_there { room } else { there }
        });
        let joined = labels.values_mut().iter_mut();
        joined
            .filter(|label| **label != 0 && now.contains(label))
            .for_each(|label| *label = self.kept);
    }
}
