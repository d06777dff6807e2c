//! Edits of saved zones and spots.

use super::Map;
use crate::mapping::annotations::PLACES_MAX;
use crate::model::edit_error::EditError;
use crate::model::kept_place::{KeptPlace, PlaceShape};
use crate::model::map_edit::PlaceEdit;
use crate::model::no_go::RoomName;
use crate::model::order::CleaningOrder;

impl Map {
    pub(super) fn admit_place_edit(&self, edit: &PlaceEdit) -> Result<(), EditError> {
        match edit {
            PlaceEdit::Keep { place, number } => self.admit_place(place, *number),
            PlaceEdit::Name { number, name } => self.admit_place_name(*number, name),
            PlaceEdit::Reshape { number, shape } => self.admit_place_shape(*number, shape),
            PlaceEdit::Forget { number } => self.admit_place_removal(*number),
        }
    }

    pub(super) fn apply_place_edit(&mut self, edit: &PlaceEdit) -> Result<(), EditError> {
        match edit {
            PlaceEdit::Keep { place, number } => self.keep_place(place.clone(), *number),
            PlaceEdit::Name { number, name } => self.name_place(*number, name.clone()),
            PlaceEdit::Reshape { number, shape } => self.reshape_place(*number, shape),
            PlaceEdit::Forget { number } => self.forget_place(*number),
        }
    }

    /// Whether a place can be saved: it must contain known floor. With a number it is restored under that number.
    ///
    /// # Errors
    /// The named reason against it.
    pub(super) fn admit_place(&self, place: &KeptPlace, number: Option<u16>) -> Result<(), EditError> {
        let known = &self.annotations().places;
        if self.knowledge().values().is_empty() {
            return Err(EditError::NoMap);
        }
        if known.kept.len() >= PLACES_MAX || known.next == u16::MAX {
            return Err(EditError::TooManyPlaces);
        }
        if number
            .is_some_and(|number| number == 0 || number >= known.next || known.kept.contains_key(&number))
        {
            return Err(EditError::NoSuchPlace);
        }
        known.may_be_called(None, place.name())?;
        self.admit_order(&CleaningOrder::new(vec![place.part()], 1)?)
    }

    /// Saves a place under its name.
    ///
    /// # Errors
    /// As [`Self::admit_place`]; then nothing is changed.
    pub fn keep_place(&mut self, place: KeptPlace, number: Option<u16>) -> Result<(), EditError> {
        self.admit_place(&place, number)?;
        let known = &mut self.home.annotations.places;
        let number = number.unwrap_or(known.next);
        known.next = known.next.max(number + 1);
        known.kept.insert(number, place);
        self.home.increment_revision();
        Ok(())
    }

    /// Whether a place can have this name.
    ///
    /// # Errors
    /// [`EditError::NoSuchPlace`], or [`EditError::NameTaken`] by another one.
    pub(super) fn admit_place_name(&self, number: u16, name: &RoomName) -> Result<(), EditError> {
        self.admit_place_removal(number)?;
        self.annotations().places.may_be_called(Some(number), name)
    }

    /// Renames a place.
    ///
    /// # Errors
    /// As [`Self::admit_place_name`]; then nothing is changed.
    pub fn name_place(&mut self, number: u16, name: RoomName) -> Result<(), EditError> {
        self.admit_place_name(number, &name)?;
        let known = self.home.annotations.places.kept.get_mut(&number);
        let known = known.ok_or(EditError::NoSuchPlace)?;
        *known = known.clone().with_name(name);
        self.home.increment_revision();
        Ok(())
    }

    /// Whether a place can have this shape.
    ///
    /// # Errors
    /// [`EditError::NoSuchPlace`], or what speaks against a new one there.
    pub(super) fn admit_place_shape(&self, number: u16, shape: &PlaceShape) -> Result<(), EditError> {
        self.reshaped(number, shape).map(drop)
    }

    fn reshaped(&self, number: u16, shape: &PlaceShape) -> Result<KeptPlace, EditError> {
        let known = self.annotations().place(number).ok_or(EditError::NoSuchPlace)?;
        let place = known.clone().with_shape(shape)?;
        self.admit_order(&CleaningOrder::new(vec![place.part()], 1)?)?;
        Ok(place)
    }

    /// Changes the shape of a place and keeps its number and name.
    ///
    /// # Errors
    /// As [`Self::admit_place_shape`]; then nothing is changed.
    pub fn reshape_place(&mut self, number: u16, shape: &PlaceShape) -> Result<(), EditError> {
        let place = self.reshaped(number, shape)?;
        self.home.annotations.places.kept.insert(number, place);
        self.home.increment_revision();
        Ok(())
    }

    /// Whether there is a place with this number.
    ///
    /// # Errors
    /// [`EditError::NoSuchPlace`] when not.
    pub(super) fn admit_place_removal(&self, number: u16) -> Result<(), EditError> {
        match self.annotations().place(number) {
            Some(_) => Ok(()),
            None => Err(EditError::NoSuchPlace),
        }
    }

    /// Deletes a saved place.
    ///
    /// # Errors
    /// [`EditError::NoSuchPlace`]; then nothing is changed.
    pub fn forget_place(&mut self, number: u16) -> Result<(), EditError> {
        let known = &mut self.home.annotations.places.kept;
        known.remove(&number).ok_or(EditError::NoSuchPlace)?;
        self.home.increment_revision();
        Ok(())
    }
}
