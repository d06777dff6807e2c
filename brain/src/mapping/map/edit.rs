//! Changes that people make to the map: whether one can be made, and making it. What each of them does stands beside this file.

use super::Map;
use crate::model::edit_error::EditError;
use crate::model::map_edit::MapEdit;

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
}
