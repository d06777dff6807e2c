//! People change the map: no-go zones, virtual walls, names and settings of rooms, and where the dock stands.

use core::f64::consts::TAU;

use super::Map;
use crate::mapping::annotations::NAMES_MAX;
use crate::mapping::home::Entry;
use crate::mapping::layers::{CellBox, Flag};
use crate::mapping::zone_cells::{cells_between, cells_of};
use crate::mapping::{Annotations, Cell, CellKnowledge, Raster};
use crate::model::edit_error::EditError;
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::no_go::{NoGo, RoomName};
use crate::model::room_settings::RoomSettings;
use crate::model::zone::{FAR_M, Zone};

impl Map {
    /// What people have said of the home.
    #[must_use]
    pub fn annotations(&self) -> &Annotations {
        &self.home.annotations
    }

    /// Whether `no_go` can be added: the map must know floor there, and the dock must stay within reach.
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
    pub(crate) fn may_forbid(&self, no_go: &NoGo) -> Result<(), EditError> {
        if self.knowledge().values().is_empty() {
            return Err(EditError::NoMap);
        }
        let knowledge = self.knowledge();
        let is_floor = |cell: Cell| {
            let kind = knowledge.get(cell);
            matches!(kind, Some(CellKnowledge::Free | CellKnowledge::NoGo))
        };
        let window = self.home.bounds().ok_or(EditError::NoMap)?;
        if !cells_of(no_go.area(), window).any(is_floor) {
            return Err(EditError::NoFloorThere);
        }
        let radius_m = self.home.pencil.body.radius_m;
        match self.dock() {
            Some(dock) if no_go.area().distance_m(dock.position()) < radius_m => Err(EditError::DockInside),
            _ => Ok(()),
        }
    }

    /// Forbids floor to all ways that are planned.
    ///
    /// # Errors
    /// As [`Self::admit_no_go`]; then nothing is changed.
    pub fn add_no_go(&mut self, no_go: NoGo) -> Result<(), EditError> {
        self.admit_no_go(&no_go)?;
        self.home.annotations.add(no_go)?;
        self.home.paint_no_go();
        self.home.touch();
        Ok(())
    }

    /// Forbids floor until the next job begins.
    pub(crate) fn avoid(&mut self, avoid: &[NoGo]) {
        let Some(window) = self.home.bounds() else { return };
        let cells = avoid.iter().flat_map(|no_go| cells_of(no_go.area(), window));
        self.home.shut(cells);
    }

    /// Cells of what is known that a job would have to keep out of.
    pub(crate) fn knowledge_avoiding(&self, avoid: &[NoGo]) -> Raster<CellKnowledge> {
        let mut knowledge = self.knowledge().clone();
        if let Some(window) = self.home.bounds() {
            for cell in avoid.iter().flat_map(|no_go| cells_of(no_go.area(), window)) {
                if let Some(kind) = knowledge.get_mut(cell) {
                    *kind = CellKnowledge::NoGo;
                }
            }
        }
        knowledge
    }

    /// Whether there is a no-go zone or virtual wall of this number.
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

    /// Allows again what a no-go zone or virtual wall forbade, unless another one does, too.
    ///
    /// # Errors
    /// [`EditError::NoSuchNoGo`]; then nothing is changed.
    pub fn remove_no_go(&mut self, number: u16) -> Result<(), EditError> {
        let removed = self.home.annotations.no_go.remove(&number);
        let removed = removed.ok_or(EditError::NoSuchNoGo)?;
        self.allow(removed.area());
        self.home.paint_no_go();
        self.home.touch();
        Ok(())
    }

    /// Takes the mark off all cells of an area; those that are forbidden all the same are to be painted again.
    fn allow(&mut self, area: &Zone) {
        let Some(window) = self.home.bounds() else { return };
        for cell in cells_of(area, window) {
            self.home.flag(cell, Flag::NoGo, Entry::Allowed);
            if let Some(redrawing) = &mut self.redrawing {
                redrawing.allow(cell);
            }
        }
    }

    /// Whether a no-go zone or virtual wall may forbid this floor in place of its own.
    ///
    /// # Errors
    /// [`EditError::NoSuchNoGo`], or what speaks against a new one there.
    pub(super) fn admit_no_go_shape(&self, number: u16, no_go: &NoGo) -> Result<(), EditError> {
        self.admit_no_go_removal(number)?;
        self.may_forbid(no_go)
    }

    /// Lets a no-go zone or virtual wall forbid other floor, under its number and name. There is no step in between in which
    /// neither of both is forbidden.
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
        self.home.touch();
        Ok(())
    }

    /// Whether a no-go zone or virtual wall may be called so; without a name it is called by its number.
    ///
    /// # Errors
    /// [`EditError::NoSuchNoGo`], or [`EditError::NameTaken`] by another one.
    pub(super) fn admit_no_go_name(&self, number: u16, name: Option<&RoomName>) -> Result<(), EditError> {
        self.admit_no_go_removal(number)?;
        name.map_or(Ok(()), |name| {
            self.home.annotations.may_forbid_as(Some(number), name)
        })
    }

    /// Names a no-go zone or virtual wall, or takes its name away.
    ///
    /// # Errors
    /// As [`Self::admit_no_go_name`]; then nothing is changed.
    pub fn name_no_go(&mut self, number: u16, name: Option<RoomName>) -> Result<(), EditError> {
        self.admit_no_go_name(number, name.as_ref())?;
        let no_go = self.home.annotations.no_go.get_mut(&number);
        let no_go = no_go.ok_or(EditError::NoSuchNoGo)?;
        *no_go = no_go.clone().with_name(name);
        self.home.touch();
        Ok(())
    }

    /// Whether a room may be called so; without a name it is called by its number.
    ///
    /// # Errors
    /// [`EditError::NoSuchRoom`], or [`EditError::NameTaken`] by another room.
    pub(super) fn admit_room_name(&self, room: u16, name: Option<&RoomName>) -> Result<(), EditError> {
        if self.rooms().rooms().iter().all(|known| known.id != room) {
            return Err(EditError::NoSuchRoom);
        }
        name.map_or(Ok(()), |name| self.home.annotations.may_be_called(room, name))
    }

    /// Names a room, or takes its name away.
    ///
    /// # Errors
    /// As [`Self::admit_room_name`]; then nothing is changed.
    pub fn name_room(&mut self, room: u16, name: Option<RoomName>) -> Result<(), EditError> {
        self.admit_room_name(room, name.as_ref())?;
        self.home.annotations.call(room, name);
        self.home.touch();
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

    /// Says how a room is cleaned; without settings as any other.
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
        self.home.touch();
        Ok(())
    }
}

impl Map {
    /// Whether the dock can stand so that a robot on it has this pose: there is floor that the map knows under its body, and no
    /// no-go zone.
    ///
    /// # Errors
    /// The named reason against it.
    pub(super) fn admit_dock_move(&self, pose: Pose2) -> Result<(), EditError> {
        let is_near = pose.x_m.abs() < FAR_M && pose.y_m.abs() < FAR_M && pose.heading_rad.is_finite();
        let window = self.home.bounds().ok_or(EditError::NoMap)?;
        if !is_near || !self.has_floor_under(pose.position(), window) {
            return Err(EditError::NoFloorThere);
        }
        let radius_m = self.home.pencil.body.radius_m;
        let mut no_gos = self.home.annotations.no_go.values();
        if no_gos.any(|no_go| no_go.area().distance_m(pose.position()) < radius_m) {
            return Err(EditError::DockInside);
        }
        Ok(())
    }

    /// A person says where the dock stands now.
    ///
    /// # Errors
    /// As [`Self::admit_dock_move`]; then nothing is changed.
    pub fn move_dock(&mut self, pose: Pose2) -> Result<(), EditError> {
        self.admit_dock_move(pose)?;
        self.home.dock.tell(Pose2 {
            heading_rad: normalize_rad(pose.heading_rad % TAU),
            ..pose
        });
        self.home.touch();
        Ok(())
    }

    fn has_floor_under(&self, place: Point2, window: CellBox) -> bool {
        let reach_m = self.home.pencil.body.radius_m;
        let corner = |sign: f64| Point2 {
            x_m: place.x_m + sign * reach_m,
            y_m: place.y_m + sign * reach_m,
        };
        let knowledge = self.knowledge();
        cells_between((corner(-1.0), corner(1.0)), window)
            .filter(|cell| cell.middle().distance_m(place) <= reach_m)
            .any(|cell| {
                let kind = knowledge.get(cell);
                matches!(kind, Some(CellKnowledge::Free | CellKnowledge::NoGo))
            })
    }
}
