//! Edits by people: no-go zones, virtual walls, names and settings of rooms, and the location of the dock.

use core::f64::consts::TAU;

use super::Map;
use crate::mapping::annotations::NAMES_MAX;
use crate::mapping::home::Access;
use crate::mapping::occupancy_grid::{CellBox, Flag};
use crate::mapping::zone_cells::{cells_between, cells_of};
use crate::mapping::{Annotations, CellKnowledge};
use crate::model::edit_error::EditError;
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::gradual::{StepBudget, at_once};
use crate::model::map_edit::NoGoEdit;
use crate::model::no_go::{NoGo, RoomName};
use crate::model::room_settings::RoomSettings;
use crate::model::zone::{COORDINATE_MAX_M, Zone};

impl Map {
    pub(super) fn admit_no_go_edit(&self, edit: &NoGoEdit) -> Result<(), EditError> {
        match edit {
            NoGoEdit::Add(no_go) => self.admit_no_go(no_go),
            NoGoEdit::Remove { number } => self.admit_no_go_removal(*number),
            NoGoEdit::Name { number, name } => self.admit_no_go_name(*number, name.as_ref()),
            NoGoEdit::Reshape { number, no_go } => self.admit_no_go_shape(*number, no_go),
        }
    }

    pub(super) fn apply_no_go_edit(&mut self, edit: &NoGoEdit) -> Result<(), EditError> {
        match edit {
            NoGoEdit::Add(no_go) => self.add_no_go(no_go.clone()),
            NoGoEdit::Remove { number } => self.remove_no_go(*number),
            NoGoEdit::Name { number, name } => self.name_no_go(*number, name.clone()),
            NoGoEdit::Reshape { number, no_go } => self.reshape_no_go(*number, no_go.clone()),
        }
    }

    /// Everything that people added to the map.
    #[must_use]
    pub fn annotations(&self) -> &Annotations {
        &self.home.annotations
    }

    /// Whether `no_go` can be added: it must cover known floor and keep clear of the dock.
    ///
    /// # Errors
    /// The named reason against it.
    pub(super) fn admit_no_go(&self, no_go: &NoGo) -> Result<(), EditError> {
        self.home.annotations.has_room_for_another()?;
        if let Some(name) = no_go.name() {
            self.home.annotations.may_forbid_as(None, name)?;
        }
        self.may_forbid(no_go)
    }

    /// Whether there is floor that `no_go` forbids, and the dock stays within reach.
    fn may_forbid(&self, no_go: &NoGo) -> Result<(), EditError> {
        let no_gos = core::slice::from_ref(no_go);
        at_once(self.home_floor().may_forbid(no_gos, &mut StepBudget::unlimited()))
    }

    /// Adds a no-go zone or virtual wall, which no planned path enters.
    ///
    /// # Errors
    /// As [`Self::admit_no_go`]; then nothing is changed.
    pub fn add_no_go(&mut self, no_go: NoGo) -> Result<(), EditError> {
        self.admit_no_go(&no_go)?;
        self.home.annotations.add(no_go)?;
        self.home.paint_no_go();
        self.home.increment_revision();
        Ok(())
    }

    /// Forbids floor until the next job begins.
    pub(crate) fn avoid(&mut self, avoid: &[NoGo]) {
        let Some(window) = self.home.bounds() else { return };
        let cells = avoid.iter().flat_map(|no_go| cells_of(no_go.area(), window));
        self.home.forbid_for_job(cells);
    }

    /// Whether there is a no-go zone or virtual wall with this number.
    ///
    /// # Errors
    /// [`EditError::NoSuchNoGo`] when not.
    pub(super) fn admit_no_go_removal(&self, number: u16) -> Result<(), EditError> {
        if self.home.annotations.no_go.contains_key(&number) {
            Ok(())
        } else {
            Err(EditError::NoSuchNoGo)
        }
    }

    /// Removes a no-go zone or virtual wall. Cells in other ones stay forbidden.
    ///
    /// # Errors
    /// [`EditError::NoSuchNoGo`]; then nothing is changed.
    pub fn remove_no_go(&mut self, number: u16) -> Result<(), EditError> {
        let removed = self.home.annotations.no_go.remove(&number);
        let removed = removed.ok_or(EditError::NoSuchNoGo)?;
        self.allow(removed.area());
        self.home.paint_no_go();
        self.home.increment_revision();
        Ok(())
    }

    /// Clears the flag of all cells of an area. The caller then paints the remaining no-go zones again.
    fn allow(&mut self, area: &Zone) {
        let Some(window) = self.home.bounds() else { return };
        for cell in cells_of(area, window) {
            self.home.flag(cell, Flag::NoGo, Access::Allowed);
            if let Some(redrawing) = &mut self.redrawing {
                redrawing.allow(cell);
            }
        }
    }

    /// Whether a no-go zone or virtual wall can have this shape instead of its own.
    ///
    /// # Errors
    /// [`EditError::NoSuchNoGo`], or what speaks against a new one there.
    pub(super) fn admit_no_go_shape(&self, number: u16, no_go: &NoGo) -> Result<(), EditError> {
        self.admit_no_go_removal(number)?;
        self.may_forbid(no_go)
    }

    /// Changes the shape of a no-go zone or virtual wall and keeps its number and name. At no moment are both shapes allowed.
    ///
    /// # Errors
    /// As [`Self::admit_no_go_shape`]; then nothing is changed.
    pub fn reshape_no_go(&mut self, number: u16, no_go: NoGo) -> Result<(), EditError> {
        self.admit_no_go_shape(number, &no_go)?;
        let known = self.home.annotations.no_go.get_mut(&number);
        let known = known.ok_or(EditError::NoSuchNoGo)?;
        let no_go = no_go.with_name(known.name().cloned());
        let before = core::mem::replace(known, no_go);
        self.allow(before.area());
        self.home.paint_no_go();
        self.home.increment_revision();
        Ok(())
    }

    /// Whether a no-go zone or virtual wall can have this name; without a name clients show its number.
    ///
    /// # Errors
    /// [`EditError::NoSuchNoGo`], or [`EditError::NameTaken`] by another one.
    pub(super) fn admit_no_go_name(&self, number: u16, name: Option<&RoomName>) -> Result<(), EditError> {
        self.admit_no_go_removal(number)?;
        name.map_or(Ok(()), |name| {
            self.home.annotations.may_forbid_as(Some(number), name)
        })
    }

    /// Names a no-go zone or virtual wall, or removes its name.
    ///
    /// # Errors
    /// As [`Self::admit_no_go_name`]; then nothing is changed.
    pub fn name_no_go(&mut self, number: u16, name: Option<RoomName>) -> Result<(), EditError> {
        self.admit_no_go_name(number, name.as_ref())?;
        let no_go = self.home.annotations.no_go.get_mut(&number);
        let no_go = no_go.ok_or(EditError::NoSuchNoGo)?;
        *no_go = no_go.clone().with_name(name);
        self.home.increment_revision();
        Ok(())
    }

    /// Whether a room can have this name; without a name clients show its number.
    ///
    /// # Errors
    /// [`EditError::NoSuchRoom`], or [`EditError::NameTaken`] by another room.
    pub(super) fn admit_room_name(&self, room: u16, name: Option<&RoomName>) -> Result<(), EditError> {
        if self.rooms().rooms().iter().all(|known| known.id != room) {
            return Err(EditError::NoSuchRoom);
        }
        name.map_or(Ok(()), |name| self.home.annotations.may_be_called(room, name))
    }

    /// Names a room, or removes its name.
    ///
    /// # Errors
    /// As [`Self::admit_room_name`]; then nothing is changed.
    pub fn name_room(&mut self, room: u16, name: Option<RoomName>) -> Result<(), EditError> {
        self.admit_room_name(room, name.as_ref())?;
        self.home.annotations.call(room, name);
        self.home.increment_revision();
        Ok(())
    }
}

impl Map {
    /// Whether a room can have settings.
    ///
    /// # Errors
    /// [`EditError::NoSuchRoom`], or [`EditError::BadSettings`] when more rooms have some than a home can have.
    pub(super) fn admit_room_settings(&self, room: u16) -> Result<(), EditError> {
        if self.rooms().rooms().iter().all(|known| known.id != room) {
            return Err(EditError::NoSuchRoom);
        }
        let settings = &self.home.annotations.settings;
        if settings.len() >= NAMES_MAX && !settings.contains_key(&room) {
            return Err(EditError::BadSettings);
        }
        Ok(())
    }

    /// Sets or removes the settings of a room.
    ///
    /// # Errors
    /// As [`Self::admit_room_settings`]; then nothing is changed.
    pub fn set_room(&mut self, room: u16, settings: Option<RoomSettings>) -> Result<(), EditError> {
        self.admit_room_settings(room)?;
        let kept = &mut self.home.annotations.settings;
        match settings.filter(|settings| *settings != RoomSettings::default()) {
            Some(settings) => kept.insert(room, settings),
            None => kept.remove(&room),
        };
        self.home.increment_revision();
        Ok(())
    }
}

impl Map {
    /// Whether the dock can be where a docked robot has this pose: known floor under its body and no no-go zone.
    ///
    /// # Errors
    /// The named reason against it.
    pub(super) fn admit_dock_move(&self, pose: Pose2) -> Result<(), EditError> {
        let is_near = pose.x_m.abs() < COORDINATE_MAX_M
            && pose.y_m.abs() < COORDINATE_MAX_M
            && pose.heading_rad.is_finite();
        let window = self.home.bounds().ok_or(EditError::NoMap)?;
        if !is_near || !self.has_floor_under(pose.position(), window) {
            return Err(EditError::NoFloorThere);
        }
        let radius_m = self.home.sensor_model.body.radius_m;
        let mut no_gos = self.home.annotations.no_go.values();
        if no_gos.any(|no_go| no_go.area().distance_m(pose.position()) < radius_m) {
            return Err(EditError::DockInside);
        }
        Ok(())
    }

    /// Moves the dock to where a person reports it.
    ///
    /// # Errors
    /// As [`Self::admit_dock_move`]; then nothing is changed.
    pub fn move_dock(&mut self, pose: Pose2) -> Result<(), EditError> {
        self.admit_dock_move(pose)?;
        self.home.dock.report(Pose2 {
            heading_rad: normalize_rad(pose.heading_rad % TAU),
            ..pose
        });
        self.home.increment_revision();
        Ok(())
    }

    fn has_floor_under(&self, place: Point2, window: CellBox) -> bool {
        let reach_m = self.home.sensor_model.body.radius_m;
        let corner = |sign: f64| Point2 {
            x_m: place.x_m + sign * reach_m,
            y_m: place.y_m + sign * reach_m,
        };
        let knowledge = self.knowledge();
        cells_between(corner(-1.0), corner(1.0), window)
            .filter(|cell| cell.middle().distance_m(place) <= reach_m)
            .any(|cell| {
                let kind = knowledge.get(cell);
                matches!(kind, Some(CellKnowledge::Free | CellKnowledge::NoGo))
            })
    }
}
