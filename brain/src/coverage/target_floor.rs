//! The floor that a part of an order asks for, and its sweep pattern.

use super::plan::SweepPattern;
use crate::mapping::{Annotations, Cell, HomeFloor, Map, Rooms};
use crate::model::order::{CleaningOrder, HomePart};
use crate::model::room_settings::Pattern;

/// The floor to sweep, as known at one time.
#[derive(Debug)]
pub(crate) struct TargetFloor {
    /// `None` = the whole home.
    part: Option<HomePart>,
    usual: SweepPattern,
    /// Rooms that are swept in rings when the whole home is cleaned.
    ring_rooms: Vec<u16>,
    rooms: Option<Rooms>,
}

impl TargetFloor {
    /// The floor of a part of an order; `None` = the whole home.
    pub(crate) fn of(order: &CleaningOrder, part: Option<&HomePart>, map: &Map) -> Self {
        Self::from_words(order, part, (map.annotations(), map.rooms()))
    }

    /// As [`Self::of`], in a home as it was at one moment.
    pub(crate) fn within(order: &CleaningOrder, part: Option<&HomePart>, home: &HomeFloor) -> Self {
        Self::from_words(order, part, (home.annotations(), home.rooms()))
    }

    fn from_words(
        order: &CleaningOrder,
        part: Option<&HomePart>,
        (words, rooms): (&Annotations, &Rooms),
    ) -> Self {
        let ring_rooms = match part {
            Some(_) => Vec::new(),
            None => words.contour_rooms(order),
        };
        let needs_rooms = part.is_some() || !ring_rooms.is_empty();
        Self {
            part: part.cloned(),
            usual: sweep_pattern(order, part, words),
            ring_rooms,
            rooms: needs_rooms.then(|| rooms.clone()),
        }
    }

    /// How a cell is to be swept, if it belongs to the target floor.
    pub(crate) fn pattern_at(&self, cell: Cell) -> Option<SweepPattern> {
        match (&self.part, &self.rooms) {
            (Some(part), Some(rooms)) => rooms.is_in_part(cell, part).then_some(self.usual),
            (None, Some(rooms)) => {
                let room = rooms.labels().get(cell);
                let is_ringed = room.is_some_and(|room| self.ring_rooms.contains(room));
                Some(if is_ringed {
                    SweepPattern::Inwards
                } else {
                    self.usual
                })
            }
            (_, None) => Some(self.usual),
        }
    }
}

/// In a spot the dirt is in the middle, so sweeping starts there.
fn sweep_pattern(order: &CleaningOrder, part: Option<&HomePart>, words: &Annotations) -> SweepPattern {
    match (part, order.pattern()) {
        (Some(HomePart::Spot(_)), None | Some(Pattern::Contour)) => SweepPattern::Outwards,
        _ => words.pattern_over(order, part).into(),
    }
}
