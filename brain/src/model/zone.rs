//! A polygon that a person draws on the floor.

use super::edit_error::EditError;
use super::geometry::Point2;

/// Most corners of a zone.
pub(crate) const CORNERS_MAX: usize = 64;
/// Limit of a zone's coordinates from the map's origin, metres.
pub const COORDINATE_MAX_M: f64 = 500.0;

/// A polygon on the floor in the map frame. Edges may cross; the even-odd rule decides what is inside.
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    corners: Vec<Point2>,
}

impl Zone {
    /// A zone of 3 to 64 corners within 500 m of the origin.
    ///
    /// # Errors
    /// [`EditError::BadZone`] for anything else.
    pub fn new(corners: Vec<Point2>) -> Result<Self, EditError> {
        let is_near =
            |corner: &Point2| corner.x_m.abs() < COORDINATE_MAX_M && corner.y_m.abs() < COORDINATE_MAX_M;
        if (3..=CORNERS_MAX).contains(&corners.len()) && corners.iter().all(is_near) {
            Ok(Self { corners })
        } else {
            Err(EditError::BadZone)
        }
    }

    /// The corners.
    #[must_use]
    pub fn corners(&self) -> &[Point2] {
        &self.corners
    }

    /// Whether it contains a point.
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

    /// Distance of a point in metres; 0 inside.
    #[must_use]
    pub fn distance_m(&self, point: Point2) -> f64 {
        if self.contains(point) {
            return 0.0;
        }
        let mut nearest_m = f64::INFINITY;
        let mut before = self.corners.last().copied().unwrap_or_default();
        for corner in &self.corners {
            nearest_m = nearest_m.min(distance_to_edge_m(point, before, *corner));
            before = *corner;
        }
        nearest_m
    }
}

fn distance_to_edge_m(point: Point2, from: Point2, to: Point2) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::Zone;
    use crate::model::edit_error::EditError;
    use crate::model::geometry::Point2;

    fn at(x_m: f64, y_m: f64) -> Point2 {
        Point2 { x_m, y_m }
    }

    #[test]
    fn a_zone_contains_the_points_within_its_corners() {
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
    fn invalid_polygons_are_refused_by_name() {
        for corners in [
            vec![],
            vec![at(0.0, 0.0), at(1.0, 0.0)],
            vec![at(0.0, 0.0); 65],
            vec![at(f64::NAN, 0.0), at(1.0, 0.0), at(1.0, 1.0)],
            vec![at(1e9, 0.0), at(1.0, 0.0), at(1.0, 1.0)],
        ] {
            assert_eq!(Zone::new(corners), Err(EditError::BadZone));
        }
    }
}
