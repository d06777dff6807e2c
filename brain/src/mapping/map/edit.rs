//! Changes that people make to the map: whether one can be made, and making it.

use super::Map;
use crate::model::edit_error::EditError;
use crate::model::map_edit::{MapEdit, NoGoEdit, PlaceEdit, RoomEdit};

impl Map {
    /// Whether an edit can be made now.
    ///
    /// # Errors
    /// Why not.
    pub fn admit(&self, edit: &MapEdit) -> Result<(), EditError> {
        match edit {
            MapEdit::NoGo(edit) => self.admit_no_go_edit(edit),
            MapEdit::Place(edit) => self.admit_place_edit(edit),
            MapEdit::Room(edit) => self.admit_room_edit(edit),
            MapEdit::Dock(pose) => self.admit_dock_move(*pose),
        }
    }

    fn admit_no_go_edit(&self, edit: &NoGoEdit) -> Result<(), EditError> {
        match edit {
            NoGoEdit::Add(no_go) => self.admit_no_go(no_go),
            NoGoEdit::Remove { number } => self.admit_no_go_removal(*number),
            NoGoEdit::Name { number, name } => self.admit_no_go_name(*number, name.as_ref()),
            NoGoEdit::Reshape { number, no_go } => self.admit_no_go_shape(*number, no_go),
        }
    }

    fn admit_place_edit(&self, edit: &PlaceEdit) -> Result<(), EditError> {
        match edit {
            PlaceEdit::Keep { place, number } => self.admit_place(place, *number),
            PlaceEdit::Name { number, name } => self.admit_place_name(*number, name),
            PlaceEdit::Reshape { number, shape } => self.admit_place_shape(*number, shape),
            PlaceEdit::Forget { number } => self.admit_place_removal(*number),
        }
    }

    fn admit_room_edit(&self, edit: &RoomEdit) -> Result<(), EditError> {
        match edit {
            RoomEdit::Name { room, name } => self.admit_room_name(*room, name.as_ref()),
            RoomEdit::Set { room, .. } => self.admit_room_settings(*room),
            RoomEdit::Split { room, line } => self.admit_room_split(*room, line),
            RoomEdit::Join { rooms } => self.admit_room_join(*rooms),
            RoomEdit::Undo { number } => self.admit_room_change_undo(*number),
        }
    }

    /// Makes an edit.
    ///
    /// # Errors
    /// As [`Self::admit`]; then nothing is changed.
    pub fn apply(&mut self, edit: &MapEdit) -> Result<(), EditError> {
        match edit {
            MapEdit::NoGo(edit) => self.apply_no_go_edit(edit),
            MapEdit::Place(edit) => self.apply_place_edit(edit),
            MapEdit::Room(edit) => self.apply_room_edit(edit),
            MapEdit::Dock(pose) => self.move_dock(*pose),
        }
    }

    fn apply_no_go_edit(&mut self, edit: &NoGoEdit) -> Result<(), EditError> {
        match edit {
            NoGoEdit::Add(no_go) => self.add_no_go(no_go.clone()),
            NoGoEdit::Remove { number } => self.remove_no_go(*number),
            NoGoEdit::Name { number, name } => self.name_no_go(*number, name.clone()),
            NoGoEdit::Reshape { number, no_go } => self.reshape_no_go(*number, no_go.clone()),
        }
    }

    fn apply_place_edit(&mut self, edit: &PlaceEdit) -> Result<(), EditError> {
        match edit {
            PlaceEdit::Keep { place, number } => self.keep_place(place.clone(), *number),
            PlaceEdit::Name { number, name } => self.name_place(*number, name.clone()),
            PlaceEdit::Reshape { number, shape } => self.reshape_place(*number, shape),
            PlaceEdit::Forget { number } => self.forget_place(*number),
        }
    }

    fn apply_room_edit(&mut self, edit: &RoomEdit) -> Result<(), EditError> {
        match edit {
            RoomEdit::Name { room, name } => self.name_room(*room, name.clone()),
            RoomEdit::Set { room, settings } => self.set_room(*room, *settings),
            RoomEdit::Split { room, line } => self.split_room(*room, *line),
            RoomEdit::Join { rooms } => self.join_rooms(*rooms),
            RoomEdit::Undo { number } => self.undo_room_change(*number),
        }
    }
}
