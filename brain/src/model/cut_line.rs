//! The line along which a person splits a room.

use super::edit_error::EditError;
use super::geometry::Point2;
use super::no_go::in_micrometres;
use super::zone::COORDINATE_MAX_M;

/// Shortest line, metres.
const LINE_MIN_M: f64 = 0.05;

/// A drawn line. Its ends are whole micrometres, as in a stored map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutLine {
    from: Point2,
    to: Point2,
}

impl CutLine {
    /// A line between two points.
    ///
    /// # Errors
    /// [`EditError::BadLine`] when they are one place or far away.
    pub fn new(from: Point2, to: Point2) -> Result<Self, EditError> {
        let is_near = |end: &Point2| end.x_m.abs() < COORDINATE_MAX_M && end.y_m.abs() < COORDINATE_MAX_M;
        let line = Self {
            from: in_micrometres(from),
            to: in_micrometres(to),
        };
        if is_near(&from) && is_near(&to) && line.length_m() >= LINE_MIN_M {
            Ok(line)
        } else {
            Err(EditError::BadLine)
        }
    }

    /// Its ends.
    #[must_use]
    pub fn ends(&self) -> [Point2; 2] {
        [self.from, self.to]
    }

    /// Its length in metres.
    pub(crate) fn length_m(&self) -> f64 {
        self.from.distance_m(self.to)
    }

    /// The point at this distance along the line; it continues beyond its ends.
    pub(crate) fn at(&self, distance_m: f64) -> Point2 {
        let share = distance_m / self.length_m();
        Point2 {
            x_m: self.from.x_m + share * (self.to.x_m - self.from.x_m),
            y_m: self.from.y_m + share * (self.to.y_m - self.from.y_m),
        }
    }
}
