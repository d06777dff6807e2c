//! Edits of rooms by people: splitting, joining and undoing.

use super::Map;
use crate::mapping::Room;
use crate::mapping::room_changes::{RoomChange, RoomJoin, RoomSplit};
use crate::mapping::room_cut::{PartSide, cut};
use crate::model::cut_line::CutLine;
use crate::model::edit_error::EditError;
use crate::model::map_edit::RoomEdit;
use crate::model::no_go::in_micrometres;

impl Map {
    pub(super) fn admit_room_edit(&self, edit: &RoomEdit) -> Result<(), EditError> {
        match edit {
            RoomEdit::Name { room, name } => self.admit_room_name(*room, name.as_ref()),
            RoomEdit::Set { room, .. } => self.admit_room_settings(*room),
            RoomEdit::Split { room, line } => self.admit_room_split(*room, line),
            RoomEdit::Join { rooms } => self.admit_room_join(*rooms),
            RoomEdit::Undo { number } => self.admit_room_change_undo(*number),
        }
    }

    pub(super) fn apply_room_edit(&mut self, edit: &RoomEdit) -> Result<(), EditError> {
        match edit {
            RoomEdit::Name { room, name } => self.name_room(*room, name.clone()),
            RoomEdit::Set { room, settings } => self.set_room(*room, *settings),
            RoomEdit::Split { room, line } => self.split_room(*room, *line),
            RoomEdit::Join { rooms } => self.join_rooms(*rooms),
            RoomEdit::Undo { number } => self.undo_room_change(*number),
        }
    }

    /// Whether a line can split a room; without a room, the one with the longest part of the line.
    ///
    /// # Errors
    /// [`EditError::NoMap`], [`EditError::NoSuchRoom`], [`EditError::LineMissesRoom`], [`EditError::LineEndsInRoom`],
    /// [`EditError::PartTooSmall`] or [`EditError::TooManyRoomChanges`].
    pub(super) fn admit_room_split(&self, room: Option<u16>, line: &CutLine) -> Result<(), EditError> {
        self.split_of(room, line).map(|_| ())
    }

    /// The room that a line would cut, and the part that would get another identity.
    fn split_of(&self, room: Option<u16>, line: &CutLine) -> Result<(u16, PartSide), EditError> {
        if self.rooms().rooms().is_empty() {
            return Err(EditError::NoMap);
        }
        if let Some(room) = room {
            self.room(room)?;
        }
        self.home.annotations.rooms.has_room_for_another()?;
        if self.home.rooms.next_id() == u16::MAX {
            return Err(EditError::TooManyRoomChanges);
        }
        let cut = cut(self.rooms().labels(), room, line)?;
        Ok((cut.room, cut.smaller()))
    }

    /// Splits a room. The larger part keeps identity and name. The other part gets a new identity, or the one that the same split
    /// gave before it was undone.
    ///
    /// # Errors
    /// As [`Self::admit_room_split`]; then nothing is changed.
    pub fn split_room(&mut self, room: Option<u16>, line: CutLine) -> Result<(), EditError> {
        let (room, side) = self.split_of(room, &line)?;
        let before = self.home.annotations.rooms.part_before(room, side, line);
        let part = before.unwrap_or_else(|| self.home.rooms.allocate_id());
        let split = RoomSplit {
            room,
            part,
            side,
            line,
        };
        self.home.annotations.rooms.add(RoomChange::Split(split))?;
        self.rooms_have_changed();
        Ok(())
    }

    /// Whether two rooms can be joined: they must be adjacent.
    ///
    /// # Errors
    /// [`EditError::NoSuchRoom`], [`EditError::RoomsApart`] or [`EditError::TooManyRoomChanges`].
    pub(super) fn admit_room_join(&self, rooms: [u16; 2]) -> Result<(), EditError> {
        self.join_of(rooms).map(|_| ())
    }

    fn join_of(&self, rooms: [u16; 2]) -> Result<RoomJoin, EditError> {
        let [one, other] = [self.room(rooms[0])?, self.room(rooms[1])?];
        let mut border = self.rooms().doors().iter();
        if !border
            .any(|door| door.rooms.contains(&one.id) && door.rooms.contains(&other.id) && one.id != other.id)
        {
            return Err(EditError::RoomsApart);
        }
        self.home.annotations.rooms.has_room_for_another()?;
        let (kept, lost) = if self.is_kept(one, other) {
            (one, other)
        } else {
            (other, one)
        };
        Ok(RoomJoin {
            kept: kept.id,
            lost: lost.id,
            at: [in_micrometres(kept.middle), in_micrometres(lost.middle)],
        })
    }

    /// A named room wins over one without a name; otherwise the larger one wins.
    fn is_kept(&self, one: &Room, other: &Room) -> bool {
        let is_named = |room: &Room| self.home.annotations.name(room.id).is_some();
        match (is_named(one), is_named(other)) {
            (true, false) => true,
            (false, true) => false,
            _ => one.area_m2 >= other.area_m2,
        }
    }

    /// Joins two rooms. The result has identity and name of the named one, or else of the larger one.
    ///
    /// # Errors
    /// As [`Self::admit_room_join`]; then nothing is changed.
    pub fn join_rooms(&mut self, rooms: [u16; 2]) -> Result<(), EditError> {
        let join = self.join_of(rooms)?;
        self.home.annotations.rooms.add(RoomChange::Join(join))?;
        self.rooms_have_changed();
        Ok(())
    }

    /// Whether a change can be undone: no later one may build on it.
    ///
    /// # Errors
    /// [`EditError::NoSuchRoomChange`] or [`EditError::RoomChangeInUse`].
    pub(super) fn admit_room_change_undo(&self, number: u16) -> Result<(), EditError> {
        self.home.annotations.rooms.may_be_taken_back(number)
    }

    /// Undoes a change. Identities and names are as before it.
    ///
    /// # Errors
    /// As [`Self::admit_room_change_undo`]; then nothing is changed.
    pub fn undo_room_change(&mut self, number: u16) -> Result<(), EditError> {
        self.home.annotations.rooms.take_back(number)?;
        self.rooms_have_changed();
        Ok(())
    }

    fn room(&self, id: u16) -> Result<&Room, EditError> {
        let known = self.rooms().rooms().iter().find(|room| room.id == id);
        known.ok_or(EditError::NoSuchRoom)
    }

    fn rooms_have_changed(&mut self) {
        self.home.segment_rooms();
        self.home.increment_revision();
    }
}

#[cfg(test)]
mod tests;
