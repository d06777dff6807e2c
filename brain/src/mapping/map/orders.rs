//! Orders in this map: the floor of their parts, and the settings of their rooms.

use super::Map;
use crate::mapping::{Annotations, Cell, Rooms};
use crate::model::edit_error::EditError;
use crate::model::gradual::{StepBudget, at_once};
use crate::model::order::{CleaningOrder, HomePart, SPOT_RADIUS_M};
use crate::model::room_settings::{Pattern, RoomSettings};

impl Rooms {
    /// Whether a cell belongs to a part of the home.
    pub(crate) fn is_in_part(&self, cell: Cell, part: &HomePart) -> bool {
        match part {
            HomePart::Room(id) => self.labels().get(cell) == Some(id),
            HomePart::Zone(zone) => zone.contains(cell.middle()),
            HomePart::Spot(place) => cell.middle().distance_m(*place) <= SPOT_RADIUS_M,
        }
    }
}

impl Annotations {
    /// Number of passes over a part: the larger one of the order and the room's settings.
    #[must_use]
    pub fn passes_over(&self, order: &CleaningOrder, part: Option<&HomePart>) -> u8 {
        let of_room = match part {
            Some(HomePart::Room(id)) => self.settings(*id).map(|settings| settings.passes()),
            _ => None,
        };
        of_room.unwrap_or(0).max(order.passes())
    }

    /// Pattern for a part: that of the order, else that of the room's settings.
    #[must_use]
    pub fn pattern_over(&self, order: &CleaningOrder, part: Option<&HomePart>) -> Pattern {
        let of_room = || match part {
            Some(HomePart::Room(id)) => self.settings(*id).map(RoomSettings::pattern),
            Some(HomePart::Zone(_) | HomePart::Spot(_)) | None => None,
        };
        order.pattern().or_else(of_room).unwrap_or_default()
    }

    /// Rooms with the contour pattern, when the whole home is cleaned and the order sets no pattern.
    pub(crate) fn contour_rooms(&self, order: &CleaningOrder) -> Vec<u16> {
        let is_contour = |settings: &RoomSettings| settings.pattern() == Pattern::Contour;
        match order.pattern() {
            Some(_) => Vec::new(),
            None => self.rooms_with(is_contour).collect(),
        }
    }
}

impl Map {
    /// Whether the map holds what is ordered.
    pub(super) fn admit_order(&self, order: &CleaningOrder) -> Result<(), EditError> {
        at_once(self.home_floor().admit_order(order, &mut StepBudget::unlimited()))
    }
}
