//! Changes of rooms by people: splits along a line, and joins.
//!
//! Changes keep their order and the identities that they gave. They are applied again after each segmentation. So they survive a
//! redrawn map, and undoing one restores the earlier rooms and identities.

use std::collections::BTreeMap;

use super::room_cut::{PartSide, nearest_cut};
use super::{Cell, Raster};
use crate::model::cut_line::CutLine;
use crate::model::edit_error::EditError;
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;

/// Most changes, and most undone splits that keep their identities.
pub(super) const CHANGES_MAX: usize = 64;
/// Work of checking a cell.
const CELL_WORK: usize = 2;

/// A change of the rooms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RoomChange {
    /// A room was split in two.
    Split(RoomSplit),
    /// Two rooms were joined.
    Join(RoomJoin),
}

/// A room that was split in two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoomSplit {
    /// The room. Its larger part keeps the identity.
    pub room: u16,
    /// Identity of the other part.
    pub part: u16,
    /// Side of that part, seen along the line.
    pub side: PartSide,
    /// The line as drawn.
    pub line: CutLine,
}

/// Two rooms that were joined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoomJoin {
    /// Identity of the joined room.
    pub kept: u16,
    /// Former identity of the other room.
    pub lost: u16,
    /// The centres of both rooms, in case their identities change.
    pub at: [Point2; 2],
}

impl RoomChange {
    /// Identities that mean something else without this change.
    pub(super) fn rooms(&self) -> [u16; 2] {
        match self {
            Self::Split(split) => [split.room, split.part],
            Self::Join(join) => [join.kept, join.lost],
        }
    }
}

/// All changes of a home's rooms.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomChanges {
    pub(super) made: BTreeMap<u16, RoomChange>,
    /// Next number; numbers are never reused.
    pub(super) next: u16,
    /// Undone splits: when repeated, they give the same identity.
    pub(super) undone: Vec<RoomSplit>,
}

impl Default for RoomChanges {
    fn default() -> Self {
        Self {
            made: BTreeMap::new(),
            next: 1,
            undone: Vec::new(),
        }
    }
}

impl RoomChanges {
    /// All changes by their numbers, from 1, in their order.
    pub fn made(&self) -> impl Iterator<Item = (u16, &RoomChange)> {
        self.made.iter().map(|(number, change)| (*number, change))
    }

    /// Whether there are no changes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.made.is_empty()
    }

    /// Whether a change or its undoing hides a room.
    pub(super) fn hides(&self, room: u16) -> bool {
        let is_joined = |change: &RoomChange| matches!(change, RoomChange::Join(join) if join.lost == room);
        self.made.values().any(is_joined) || self.undone.iter().any(|split| split.part == room)
    }

    /// The number of a later change that builds on this one, if there is one.
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
            self.undone.retain(|before| before.part != split.part);
        }
        self.made.insert(self.next, change);
        self.next = self.next.saturating_add(1);
        Ok(())
    }

    /// Identity that the same split gave before it was undone.
    pub(super) fn part_before(&self, room: u16, side: PartSide, line: CutLine) -> Option<u16> {
        let is_same = |split: &&RoomSplit| (split.room, split.side, split.line) == (room, side, line);
        self.undone.iter().rev().find(is_same).map(|split| split.part)
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
            if self.undone.len() >= CHANGES_MAX {
                self.undone.remove(0);
            }
            self.undone.push(split);
        }
        Ok(())
    }

    /// Applies all changes to segmented rooms. Every cell of a room stays in a room.
    pub(super) async fn apply_to(&self, found: &Raster<u16>, budget: &mut StepBudget) -> Raster<u16> {
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
    /// Splits its room, or the one under its line if the identity has changed. If the line no longer reaches from border to
    /// border, each cell goes to the nearer side. A line that misses all rooms has no effect until it crosses one again.
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
