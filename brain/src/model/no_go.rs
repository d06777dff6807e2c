//! No-go zones, virtual walls, and names.

use super::edit_error::EditError;
use super::geometry::Point2;
use super::zone::Zone;

/// Thickness of a virtual wall, metres: thick enough to cover every cell on its line.
const WALL_M: f64 = 0.06;
/// Most characters of a room's name.
const NAME_MAX: usize = 40;

/// Floor that the robot must not enter. Its coordinates are whole micrometres, as in a stored map.
#[derive(Clone, Debug, PartialEq)]
pub struct NoGo {
    shape: NoGoShape,
    area: Zone,
    name: Option<RoomName>,
}

/// Shape of a no-go zone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoGoShape {
    /// A zone.
    Zone,
    /// A virtual wall.
    Wall {
        /// One end.
        from: Point2,
        /// The other end.
        to: Point2,
    },
}

impl NoGo {
    /// A zone.
    ///
    /// # Errors
    /// [`EditError::BadZone`] when its corners are not those of a zone.
    pub fn zone(zone: &Zone) -> Result<Self, EditError> {
        let corners = zone.corners().iter().copied().map(in_micrometres).collect();
        Ok(Self {
            shape: NoGoShape::Zone,
            area: Zone::of_stored(corners)?,
            name: None,
        })
    }

    /// A virtual wall, as a thin zone along a line.
    ///
    /// # Errors
    /// [`EditError::BadZone`] when the ends are one place or far away.
    pub fn wall(from: Point2, to: Point2) -> Result<Self, EditError> {
        let (from, to) = (in_micrometres(from), in_micrometres(to));
        Ok(Self {
            shape: NoGoShape::Wall { from, to },
            area: thin_zone(from, to)?,
            name: None,
        })
    }

    /// The same under another name, or none.
    #[must_use]
    pub fn with_name(self, name: Option<RoomName>) -> Self {
        Self { name, ..self }
    }

    /// Its name, if it has one.
    #[must_use]
    pub const fn name(&self) -> Option<&RoomName> {
        self.name.as_ref()
    }

    /// Its shape.
    #[must_use]
    pub fn shape(&self) -> NoGoShape {
        self.shape
    }

    /// The forbidden floor.
    #[must_use]
    pub fn area(&self) -> &Zone {
        &self.area
    }
}

fn thin_zone(from: Point2, to: Point2) -> Result<Zone, EditError> {
    let length_m = from.distance_m(to);
    if length_m <= 0.0 || length_m.is_nan() {
        return Err(EditError::BadZone);
    }
    let half = 0.5 * WALL_M / length_m;
    let (along_x, along_y) = (half * (to.x_m - from.x_m), half * (to.y_m - from.y_m));
    let corner = |end: Point2, ahead: f64, left: f64| Point2 {
        x_m: end.x_m + ahead * along_x - left * along_y,
        y_m: end.y_m + ahead * along_y + left * along_x,
    };
    Zone::of_stored(vec![
        corner(from, -1.0, 1.0),
        corner(from, -1.0, -1.0),
        corner(to, 1.0, -1.0),
        corner(to, 1.0, 1.0),
    ])
}

/// Rounds to the resolution of a stored map, so that a loaded point is bit-identical.
pub(crate) fn in_micrometres(point: Point2) -> Point2 {
    let rounded = |metres: f64| (libm::round(metres * 1e6) as i64) as f64 * 1e-6;
    if !(point.x_m.is_finite() && point.y_m.is_finite()) {
        return point;
    }
    Point2 {
        x_m: rounded(point.x_m),
        y_m: rounded(point.y_m),
    }
}

/// Name of a room, place or storey: 1 to 40 characters on one line, without spaces at its ends.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct RoomName(String);

impl RoomName {
    /// A name; surrounding spaces are removed.
    ///
    /// # Errors
    /// [`EditError::BadName`] for one that is empty, longer than 40 characters, or holds characters that cannot be seen.
    pub fn new(text: &str) -> Result<Self, EditError> {
        let text = text.trim();
        if text.is_empty() || text.chars().count() > NAME_MAX || text.chars().any(char::is_control) {
            return Err(EditError::BadName);
        }
        Ok(Self(text.to_owned()))
    }

    /// The text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Whether the names are equal but for case and surrounding spaces.
    #[must_use]
    pub fn sounds_like(&self, other: &str) -> bool {
        self.0.to_lowercase() == other.trim().to_lowercase()
    }
}

#[cfg(test)]
mod tests {
    use super::{NoGo, RoomName};
    use crate::model::edit_error::EditError;
    use crate::model::geometry::Point2;

    fn at(x_m: f64, y_m: f64) -> Point2 {
        Point2 { x_m, y_m }
    }

    #[test]
    fn a_virtual_wall_is_as_long_as_its_line_and_thin() {
        let wall = NoGo::wall(at(1.0, 1.0), at(1.0, 3.0)).unwrap();
        let wall = wall.area();
        assert!(wall.contains(at(1.02, 1.1)) && wall.contains(at(0.98, 2.9)));
        assert!(!wall.contains(at(1.05, 2.0)) && !wall.contains(at(1.0, 3.1)));
    }

    #[test]
    fn a_wall_without_length_or_too_far_away_is_refused() {
        for (from, to) in [
            (at(1.0, 1.0), at(1.0, 1.0)),
            (at(0.0, 0.0), at(1e9, 0.0)),
            (at(f64::NAN, 0.0), at(1.0, 0.0)),
            (at(0.0, 0.0), at(1e-7, 0.0)),
        ] {
            assert_eq!(NoGo::wall(from, to), Err(EditError::BadZone), "{from:?} {to:?}");
        }
    }

    #[test]
    fn a_name_is_one_short_line() {
        assert_eq!(RoomName::new("  Köök ").unwrap().as_str(), "Köök");
        assert!(RoomName::new("Kitchen").unwrap().sounds_like(" kitchen"));
        let long = "x".repeat(41);
        for name in ["", "   ", "two\nlines", long.as_str()] {
            assert_eq!(RoomName::new(name), Err(EditError::BadName), "{name:?}");
        }
    }
}
