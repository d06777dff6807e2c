//! Rectangles along the axes, and the frames of things at walls.

use crate::point::Point;

/// A rectangle, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) low: Point,
    pub(super) high: Point,
}

impl Rect {
    pub(super) fn new(a: Point, b: Point) -> Self {
        Self {
            low: [a[0].min(b[0]), a[1].min(b[1])],
            high: [a[0].max(b[0]), a[1].max(b[1])],
        }
    }

    pub(super) fn width(&self) -> f64 {
        self.high[0] - self.low[0]
    }

    pub(super) fn depth(&self) -> f64 {
        self.high[1] - self.low[1]
    }

    pub(super) fn area_m2(&self) -> f64 {
        self.width() * self.depth()
    }

    pub(super) fn grown(&self, by_m: f64) -> Self {
        Self {
            low: [self.low[0] - by_m, self.low[1] - by_m],
            high: [self.high[0] + by_m, self.high[1] + by_m],
        }
    }

    /// Whether they share more than a border.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        (0..2)
            .all(|axis| self.low[axis] < other.high[axis] - 1e-6 && other.low[axis] < self.high[axis] - 1e-6)
    }

    pub(super) fn contains(&self, inner: &Self) -> bool {
        (0..2).all(|axis| {
            inner.low[axis] >= self.low[axis] - 1e-6 && inner.high[axis] <= self.high[axis] + 1e-6
        })
    }

    pub(super) fn corners(&self) -> Vec<Point> {
        vec![
            self.low,
            [self.high[0], self.low[1]],
            self.high,
            [self.low[0], self.high[1]],
        ]
    }
}

/// A side of a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RoomSide {
    South,
    East,
    North,
    West,
}

impl RoomSide {
    pub(super) const ALL: [Self; 4] = [Self::South, Self::East, Self::North, Self::West];

    pub(super) const fn opposite(self) -> Self {
        match self {
            Self::South => Self::North,
            Self::East => Self::West,
            Self::North => Self::South,
            Self::West => Self::East,
        }
    }
}

/// A frame whose x runs along a wall and whose y points into the room.
#[derive(Clone, Copy, Debug)]
pub(super) struct WallFrame {
    pub(super) origin: Point,
    pub(super) along: Point,
    pub(super) into: Point,
}

impl WallFrame {
    /// The frame of a side of a room, with its origin at the right-hand end as seen from the room.
    pub(super) fn of_side(room: &Rect, side: RoomSide) -> Self {
        let (origin, along, into) = match side {
            RoomSide::South => (room.low, [1.0, 0.0], [0.0, 1.0]),
            RoomSide::East => ([room.high[0], room.low[1]], [0.0, 1.0], [-1.0, 0.0]),
            RoomSide::North => (room.high, [-1.0, 0.0], [0.0, -1.0]),
            RoomSide::West => ([room.low[0], room.high[1]], [0.0, -1.0], [1.0, 0.0]),
        };
        Self { origin, along, into }
    }

    /// Length of a side of a room.
    pub(super) fn length_of(room: &Rect, side: RoomSide) -> f64 {
        match side {
            RoomSide::South | RoomSide::North => room.width(),
            RoomSide::East | RoomSide::West => room.depth(),
        }
    }

    pub(super) fn point(&self, x_m: f64, y_m: f64) -> Point {
        [
            self.origin[0] + self.along[0] * x_m + self.into[0] * y_m,
            self.origin[1] + self.along[1] * x_m + self.into[1] * y_m,
        ]
    }

    /// The same frame with its origin elsewhere in it.
    pub(super) fn moved(&self, x_m: f64, y_m: f64) -> Self {
        Self {
            origin: self.point(x_m, y_m),
            ..*self
        }
    }

    /// A rectangle given in this frame.
    pub(super) fn rect(&self, a: Point, b: Point) -> Rect {
        Rect::new(self.point(a[0], a[1]), self.point(b[0], b[1]))
    }
}
