//! What of the home a job cleans, in which order and how often; and where the robot must not go.

use crate::behavior::Reason;
use crate::geometry::Point2;
use crate::mapping::{Annotations, Cell, CellKnowledge, Map, Rooms};
use crate::no_go::NoGo;
use crate::room_settings::{Pattern, RoomPower, RoomSettings};
use crate::spot::DISC_M;

/// Most parts of an order.
const PARTS_MAX: usize = 32;
/// Most corners of a zone.
pub(crate) const CORNERS_MAX: usize = 64;
/// Most places that a job may be told to keep out of.
const AVOID_MAX: usize = 16;
/// Most passes over a part.
pub(crate) const PASSES_MAX: u8 = 3;
/// Corners of a zone are nearer to the map's origin than this, metres.
pub const FAR_M: f64 = 500.0;

/// A polygon on the floor in the map frame. Edges may cross; what lies inside an odd number of times is in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    corners: Vec<Point2>,
}

impl Zone {
    /// A zone of 3 to 64 corners within 500 m of the origin.
    ///
    /// # Errors
    /// [`Reason::BadZone`] for anything else.
    pub fn new(corners: Vec<Point2>) -> Result<Self, Reason> {
        let is_near = |corner: &Point2| corner.x_m.abs() < FAR_M && corner.y_m.abs() < FAR_M;
        if (3..=CORNERS_MAX).contains(&corners.len()) && corners.iter().all(is_near) {
            Ok(Self { corners })
        } else {
            Err(Reason::BadZone)
        }
    }

    /// The corners.
    #[must_use]
    pub fn corners(&self) -> &[Point2] {
        &self.corners
    }

    /// Whether a point lies in it.
    #[must_use]
    pub fn contains(&self, point: Point2) -> bool {
        let mut is_inside = false;
        let mut before = self.corners.last().copied().unwrap_or_default();
        for corner in &self.corners {
            if (corner.y_m > point.y_m) != (before.y_m > point.y_m) {
                let share = (point.y_m - corner.y_m) / (before.y_m - corner.y_m);
                is_inside ^= point.x_m < corner.x_m + share * (before.x_m - corner.x_m);
            }
            before = *corner;
        }
        is_inside
    }

    /// How far a point is from it, in metres; 0 inside.
    #[must_use]
    pub fn distance_m(&self, point: Point2) -> f64 {
        if self.contains(point) {
            return 0.0;
        }
        let mut nearest_m = f64::INFINITY;
        let mut before = self.corners.last().copied().unwrap_or_default();
        for corner in &self.corners {
            nearest_m = nearest_m.min(distance_to_edge_m(point, (before, *corner)));
            before = *corner;
        }
        nearest_m
    }
}

fn distance_to_edge_m(point: Point2, (from, to): (Point2, Point2)) -> f64 {
    let (along_x, along_y) = (to.x_m - from.x_m, to.y_m - from.y_m);
    let square = along_x * along_x + along_y * along_y;
    let ahead = (point.x_m - from.x_m) * along_x + (point.y_m - from.y_m) * along_y;
    let share = if square > 0.0 {
        (ahead / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    point.distance_m(Point2 {
        x_m: from.x_m + share * along_x,
        y_m: from.y_m + share * along_y,
    })
}

/// A part of the home.
#[derive(Clone, Debug, PartialEq)]
pub enum HomePart {
    /// A room by its identity in the map.
    Room(u16),
    /// A zone.
    Zone(Zone),
    /// The disc of [`DISC_M`] around a place.
    Spot(Point2),
}

impl HomePart {
    /// Whether a cell belongs to it.
    pub(crate) fn contains(&self, cell: Cell, rooms: &Rooms) -> bool {
        match self {
            Self::Room(id) => rooms.labels().get(cell) == Some(id),
            Self::Zone(zone) => zone.contains(cell.middle()),
            Self::Spot(place) => cell.middle().distance_m(*place) <= DISC_M,
        }
    }
}

/// What a job shall clean. The default is the whole home, once.
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
    /// Up to 32 parts, cleaned one after the other, each 1 to 3 times before the next. No part means the whole home.
    ///
    /// # Errors
    /// [`Reason::BadOrder`] for more parts or another number of passes.
    pub fn new(parts: Vec<HomePart>, passes: u8) -> Result<Self, Reason> {
        if parts.len() <= PARTS_MAX && (1..=PASSES_MAX).contains(&passes) {
            Ok(Self {
                parts,
                passes,
                ..Self::default()
            })
        } else {
            Err(Reason::BadOrder)
        }
    }

    /// The same, and the robot keeps out of up to 16 places until the next job begins.
    ///
    /// # Errors
    /// [`Reason::TooManyNoGos`] for more of them.
    pub fn avoiding(self, avoid: Vec<NoGo>) -> Result<Self, Reason> {
        if avoid.len() <= AVOID_MAX {
            Ok(Self { avoid, ..self })
        } else {
            Err(Reason::TooManyNoGos)
        }
    }

    /// The same, with brushes and suction running so wherever the job cleans, whatever is set for the rooms.
    ///
    /// # Errors
    /// [`Reason::BadSettings`] for more than 100 percent, or when nothing would run.
    pub fn with_power(self, power: RoomPower) -> Result<Self, Reason> {
        if power.is_possible() {
            Ok(Self {
                power: Some(power),
                ..self
            })
        } else {
            Err(Reason::BadSettings)
        }
    }

    /// The same, swept by this pattern, whatever is set for the rooms.
    #[must_use]
    pub fn with_pattern(self, pattern: Pattern) -> Self {
        Self {
            pattern: Some(pattern),
            ..self
        }
    }

    /// How hard brushes and suction run if the order says it.
    #[must_use]
    pub const fn power(&self) -> Option<RoomPower> {
        self.power
    }

    /// By which pattern floor is swept if the order says it.
    #[must_use]
    pub const fn pattern(&self) -> Option<Pattern> {
        self.pattern
    }

    /// Where the robot does not go in this job.
    #[must_use]
    pub fn avoid(&self) -> &[NoGo] {
        &self.avoid
    }

    /// The parts in their order.
    #[must_use]
    pub fn parts(&self) -> &[HomePart] {
        &self.parts
    }

    /// Whether it is for the whole home, and not for parts of it.
    #[must_use]
    pub const fn is_for_whole_home(&self) -> bool {
        self.parts.is_empty()
    }

    /// How often each part is cleaned at least.
    #[must_use]
    pub const fn passes(&self) -> u8 {
        self.passes
    }

    /// How often a part is cleaned: as the order says, or more often if that is a setting of the room.
    #[must_use]
    pub fn passes_over(&self, part: Option<&HomePart>, words: &Annotations) -> u8 {
        let of_room = match part {
            Some(HomePart::Room(id)) => words.settings(*id).map(|settings| settings.passes()),
            _ => None,
        };
        of_room.unwrap_or(0).max(self.passes)
    }

    /// In which way a part is swept: as the order says, else as is set for the room.
    #[must_use]
    pub fn pattern_over(&self, part: Option<&HomePart>, words: &Annotations) -> Pattern {
        let of_room = || match part {
            Some(HomePart::Room(id)) => words.settings(*id).map(RoomSettings::pattern),
            Some(HomePart::Zone(_) | HomePart::Spot(_)) | None => None,
        };
        self.pattern.or_else(of_room).unwrap_or_default()
    }

    /// Rooms that are swept in rings when the whole home is cleaned and the order does not say how.
    pub(crate) fn contour_rooms(&self, words: &Annotations) -> Vec<u16> {
        let is_contour = |settings: &RoomSettings| settings.pattern() == Pattern::Contour;
        match self.pattern {
            Some(_) => Vec::new(),
            None => words.rooms_with(is_contour).collect(),
        }
    }

    /// Whether the map holds what is ordered.
    pub(crate) fn fits(&self, map: &Map) -> Result<(), Reason> {
        let knowledge = map.knowledge();
        let has_floor = |part: &HomePart| {
            (0..knowledge.values().len())
                .filter(|index| knowledge.values().get(*index) == Some(&CellKnowledge::Free))
                .any(|index| part.contains(knowledge.cell(index), map.rooms()))
        };
        for part in &self.parts {
            match part {
                HomePart::Room(id) if map.rooms().rooms().iter().all(|room| room.id != *id) => {
                    return Err(Reason::NoSuchRoom);
                }
                HomePart::Zone(_) | HomePart::Spot(_) if !has_floor(part) => {
                    return Err(Reason::NoFloorThere);
                }
                _ => {}
            }
        }
        self.avoid.iter().try_for_each(|no_go| map.may_forbid(no_go))
    }
}

#[cfg(test)]
mod tests {
    use super::{CleaningOrder, HomePart, Zone};
    use crate::behavior::Reason;
    use crate::geometry::Point2;

    fn at(x_m: f64, y_m: f64) -> Point2 {
        Point2 { x_m, y_m }
    }

    #[test]
    fn a_zone_holds_what_lies_within_its_corners() {
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0)];
        let zone = Zone::new(corners.map(|(x, y)| at(x, y)).to_vec()).unwrap();
        for (place, inside) in [
            (at(0.2, 3.0), true),
            (at(2.0, 0.5), true),
            (at(2.0, 1.5), false),
            (at(3.9, 3.0), true),
            (at(-0.1, 1.0), false),
            (at(1.0, -0.1), false),
        ] {
            assert_eq!(zone.contains(place), inside, "{place:?}");
        }
    }

    #[test]
    fn the_distance_to_a_zone_is_that_to_its_nearest_edge() {
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)];
        let zone = Zone::new(corners.map(|(x, y)| at(x, y)).to_vec()).unwrap();
        for (place, distance_m) in [(at(1.0, 0.5), 0.0), (at(1.0, 1.5), 0.5), (at(5.0, 5.0), 5.0)] {
            assert!((zone.distance_m(place) - distance_m).abs() < 1e-12, "{place:?}");
        }
    }

    #[test]
    fn what_makes_no_sense_is_refused_by_name() {
        for corners in [
            vec![],
            vec![at(0.0, 0.0), at(1.0, 0.0)],
            vec![at(0.0, 0.0); 65],
            vec![at(f64::NAN, 0.0), at(1.0, 0.0), at(1.0, 1.0)],
            vec![at(1e9, 0.0), at(1.0, 0.0), at(1.0, 1.0)],
        ] {
            assert_eq!(Zone::new(corners), Err(Reason::BadZone));
        }
        for passes in [0, 4] {
            assert_eq!(CleaningOrder::new(vec![], passes), Err(Reason::BadOrder));
        }
        let rooms = vec![HomePart::Room(1); 33];
        assert_eq!(CleaningOrder::new(rooms, 1), Err(Reason::BadOrder));
    }
}
