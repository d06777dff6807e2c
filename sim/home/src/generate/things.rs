//! The parts of a generated home, before it is written.

use super::shape::Rect;
use crate::point::Point;

/// What a room is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RoomKind {
    Living,
    Studio,
    Kitchen,
    Bedroom,
    Child,
    Office,
    Bath,
    Toilet,
    Corridor,
    Storage,
}

impl RoomKind {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Living => "Living room",
            Self::Studio => "Room",
            Self::Kitchen => "Kitchen",
            Self::Bedroom => "Bedroom",
            Self::Child => "Child's room",
            Self::Office => "Study",
            Self::Bath => "Bathroom",
            Self::Toilet => "Toilet",
            Self::Corridor => "Corridor",
            Self::Storage => "Storeroom",
        }
    }
}

/// A room.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    pub(super) kind: RoomKind,
    pub(super) rect: Rect,
}

/// A gap in a wall with a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedDoor {
    pub(super) ends: [Point; 2],
    pub(super) open: bool,
    /// Height of the threshold, metres; 0 = none.
    pub(super) threshold_m: f64,
}

impl PlacedDoor {
    /// What must stay free of furniture.
    pub(super) fn clear(&self) -> Rect {
        Rect::new(self.ends[0], self.ends[1]).grown(0.7)
    }
}

/// Something solid.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) name: &'static str,
    pub(super) polygon: Vec<Point>,
    pub(super) legs: Vec<Point>,
    pub(super) leg_diameter_m: f64,
}

/// A rug.
#[derive(Clone, Debug)]
pub(super) struct Rug {
    pub(super) polygon: Vec<Point>,
    pub(super) drag_n: f64,
    pub(super) slip: f64,
    pub(super) bias_deg_per_m: f64,
    /// A cliff sensor detects no floor on it.
    pub(super) black: bool,
}

/// A straight thing on the floor or a wall.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedLine {
    pub(super) ends: [Point; 2],
    pub(super) thickness_m: f64,
}

/// A person who blocks the robot's path for a while.
#[derive(Clone, Copy, Debug)]
pub(super) struct Visitor {
    pub(super) place: Point,
    pub(super) diameter_m: f64,
    pub(super) from_s: f64,
    pub(super) until_s: f64,
}

/// Somebody who walks from place to place.
#[derive(Clone, Debug)]
pub(super) struct PlacedWalker {
    pub(super) kind: &'static str,
    pub(super) goals: Vec<Point>,
    pub(super) rest_s: f64,
    pub(super) from_s: f64,
    pub(super) until_s: f64,
}

/// Everything.
#[derive(Clone, Debug, Default)]
pub(super) struct Things {
    pub(super) rooms: Vec<Room>,
    pub(super) walls: Vec<PlacedLine>,
    pub(super) doors: Vec<PlacedDoor>,
    pub(super) cables: Vec<PlacedLine>,
    pub(super) rugs: Vec<Rug>,
    pub(super) pieces: Vec<Piece>,
    pub(super) stairs: Vec<Rect>,
    pub(super) mirrors: Vec<PlacedLine>,
    pub(super) visitors: Vec<Visitor>,
    pub(super) walkers: Vec<PlacedWalker>,
    /// The dock's place and the direction into the room.
    pub(super) dock: Option<(Point, Point)>,
}
