//! Cleaning orders: which parts of the home, how often, and which areas to avoid.

use super::edit_error::EditError;
use super::geometry::Point2;
use super::no_go::NoGo;
use super::room_settings::{PASSES_MAX, Pattern, RoomPower};
use super::zone::Zone;

/// Most parts of an order.
const PARTS_MAX: usize = 32;
/// Most areas to avoid in a job.
const AVOID_MAX: usize = 16;
/// Radius of a spot in metres.
pub const SPOT_RADIUS_M: f64 = 0.5;

/// A part of the home.
#[derive(Clone, Debug, PartialEq)]
pub enum HomePart {
    /// A room by its identity in the map.
    Room(u16),
    /// A zone.
    Zone(Zone),
    /// The disc of [`SPOT_RADIUS_M`] around a point.
    Spot(Point2),
}

/// What a job cleans. The default is the whole home, once.
#[derive(Clone, Debug, PartialEq)]
pub struct CleaningOrder {
    parts: Vec<HomePart>,
    passes: u8,
    avoid: Vec<NoGo>,
    power: Option<RoomPower>,
    pattern: Option<Pattern>,
}

impl Default for CleaningOrder {
    fn default() -> Self {
        Self {
            parts: Vec::new(),
            passes: 1,
            avoid: Vec::new(),
            power: None,
            pattern: None,
        }
    }
}

impl CleaningOrder {
    /// Up to 32 parts, cleaned one after the other, each 1 to 3 times before the next. No parts means the whole home.
    ///
    /// # Errors
    /// [`EditError::BadOrder`] for more parts or another number of passes.
    pub fn new(parts: Vec<HomePart>, passes: u8) -> Result<Self, EditError> {
        if parts.len() <= PARTS_MAX && (1..=PASSES_MAX).contains(&passes) {
            Ok(Self {
                parts,
                passes,
                ..Self::default()
            })
        } else {
            Err(EditError::BadOrder)
        }
    }

    /// One place, to which a robot is sent.
    #[must_use]
    pub fn of_place(place: Point2) -> Self {
        Self {
            parts: vec![HomePart::Spot(place)],
            ..Self::default()
        }
    }

    /// The same, with up to 16 areas to avoid until the next job begins.
    ///
    /// # Errors
    /// [`EditError::TooManyNoGos`] for more of them.
    pub fn avoiding(self, avoid: Vec<NoGo>) -> Result<Self, EditError> {
        if avoid.len() <= AVOID_MAX {
            Ok(Self { avoid, ..self })
        } else {
            Err(EditError::TooManyNoGos)
        }
    }

    /// The same, with this power of brushes and suction everywhere, regardless of room settings.
    ///
    /// # Errors
    /// [`EditError::BadSettings`] for more than 100 percent, or when nothing would run.
    pub fn with_power(self, power: RoomPower) -> Result<Self, EditError> {
        if power.is_possible() {
            Ok(Self {
                power: Some(power),
                ..self
            })
        } else {
            Err(EditError::BadSettings)
        }
    }

    /// The same, with this pattern everywhere, regardless of room settings.
    #[must_use]
    pub fn with_pattern(self, pattern: Pattern) -> Self {
        Self {
            pattern: Some(pattern),
            ..self
        }
    }

    /// Power of brushes and suction, if the order sets it.
    #[must_use]
    pub const fn power(&self) -> Option<RoomPower> {
        self.power
    }

    /// Cleaning pattern, if the order sets it.
    #[must_use]
    pub const fn pattern(&self) -> Option<Pattern> {
        self.pattern
    }

    /// Areas to avoid in this job.
    #[must_use]
    pub fn avoid(&self) -> &[NoGo] {
        &self.avoid
    }

    /// The parts in their order.
    #[must_use]
    pub fn parts(&self) -> &[HomePart] {
        &self.parts
    }

    /// Whether it is for the whole home.
    #[must_use]
    pub const fn is_for_whole_home(&self) -> bool {
        self.parts.is_empty()
    }

    /// Least number of passes over each part.
    #[must_use]
    pub const fn passes(&self) -> u8 {
        self.passes
    }
}

#[cfg(test)]
mod tests {
    use super::{CleaningOrder, HomePart};
    use crate::model::edit_error::EditError;

    #[test]
    fn invalid_orders_are_refused_by_name() {
        for passes in [0, 4] {
            assert_eq!(CleaningOrder::new(vec![], passes), Err(EditError::BadOrder));
        }
        let rooms = vec![HomePart::Room(1); 33];
        assert_eq!(CleaningOrder::new(rooms, 1), Err(EditError::BadOrder));
    }
}
