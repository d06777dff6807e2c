//! A polygon that a person draws on the floor.

use super::edit_error::EditError;
use super::geometry::Point2;

/// Most corners of a zone.
pub(crate) const CORNERS_MAX: usize = 64;
/// Limit of a zone's coordinates from the map's origin, metres.
pub const COORDINATE_MAX_M: f64 = 500.0;

/// Corners closer than this are one corner, metres.
const SAME_M: f64 = 0.001;
/// Least floor of a zone, square metres.
const LEAST_M2: f64 = 0.005;
/// Least floor for each metre of the outline, metres: half of the width of a long zone.
const LEAST_HALF_WIDTH_M: f64 = 0.01;

/// A polygon on the floor in the map frame. The edges of one that is drawn anew do not cross. Those of a stored one may; whatever its
/// outline goes round is inside.
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
        if !(3..=CORNERS_MAX).contains(&corners.len()) || !corners.iter().all(is_near) {
            return Err(EditError::BadZone);
        }
        let corners = without_repeats(corners);
        if corners.len() < 3 {
            return Err(EditError::ZoneTooThin);
        }
        if crosses(&corners) {
            return Err(EditError::ZoneCrosses);
        }
        let (area_m2, outline_m) = extent(&corners);
        if area_m2 < LEAST_M2 || area_m2 < LEAST_HALF_WIDTH_M * outline_m / 2.0 {
            return Err(EditError::ZoneTooThin);
        }
        Ok(Self { corners })
    }

    /// A zone that was drawn before its edges were checked: it stays what it was.
    ///
    /// # Errors
    /// [`EditError::BadZone`] for too few or too many corners, or far ones.
    pub fn of_stored(corners: Vec<Point2>) -> Result<Self, EditError> {
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

    /// Whether it contains a point: its outline goes round it. Where a stored outline goes round a point twice there is no hole.
    #[must_use]
    pub fn contains(&self, point: Point2) -> bool {
        let (mut is_inside, mut turns) = (false, 0_i32);
        let mut before = self.corners.last().copied().unwrap_or_default();
        for corner in &self.corners {
            if (corner.y_m > point.y_m) != (before.y_m > point.y_m) {
                let share = (point.y_m - corner.y_m) / (before.y_m - corner.y_m);
                if point.x_m < corner.x_m + share * (before.x_m - corner.x_m) {
                    is_inside = !is_inside;
                    turns += if corner.y_m > before.y_m { 1 } else { -1 };
                }
            }
            before = *corner;
        }
        is_inside || turns != 0
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

/// The corners without those that repeat the one before.
fn without_repeats(corners: Vec<Point2>) -> Vec<Point2> {
    let mut kept: Vec<Point2> = Vec::with_capacity(corners.len());
    for corner in corners {
        if kept
            .last()
            .is_none_or(|before| before.distance_m(corner) > SAME_M)
        {
            kept.push(corner);
        }
    }
    while let ([first, .., last], true) = (kept.as_slice(), kept.len() > 1)
        && first.distance_m(*last) <= SAME_M
    {
        kept.pop();
    }
    kept
}

/// Area and length of an outline.
fn extent(corners: &[Point2]) -> (f64, f64) {
    let (mut doubled_m2, mut outline_m) = (0.0, 0.0);
    for (from, to) in edges(corners) {
        doubled_m2 += from.x_m * to.y_m - to.x_m * from.y_m;
        outline_m += from.distance_m(to);
    }
    (0.5 * doubled_m2.abs(), outline_m)
}

fn edges(corners: &[Point2]) -> impl Iterator<Item = (Point2, Point2)> + Clone + '_ {
    let ends = corners.iter().skip(1).chain(corners.first());
    corners.iter().copied().zip(ends.copied())
}

/// Whether two edges meet anywhere but in the corner that they share, or neighbours fold back over each other.
fn crosses(corners: &[Point2]) -> bool {
    let count = corners.len();
    edges(corners).enumerate().any(|(first, one)| {
        let mut later = edges(corners).enumerate().skip(first + 1);
        later.any(|(second, other)| {
            if second == first + 1 {
                folds_back(one, other)
            } else if first == 0 && second == count - 1 {
                folds_back(other, one)
            } else {
                meet(one, other)
            }
        })
    })
}

/// Twice the area of a triangle, positive counter-clockwise.
fn side(from: Point2, to: Point2, point: Point2) -> f64 {
    (to.x_m - from.x_m) * (point.y_m - from.y_m) - (to.y_m - from.y_m) * (point.x_m - from.x_m)
}

/// Whether the second edge runs back over the first one, at whose end it begins.
fn folds_back((from, corner): (Point2, Point2), (_, to): (Point2, Point2)) -> bool {
    let (in_x, in_y) = (corner.x_m - from.x_m, corner.y_m - from.y_m);
    let (out_x, out_y) = (to.x_m - corner.x_m, to.y_m - corner.y_m);
    let ahead = in_x * out_x + in_y * out_y;
    let lengths = from.distance_m(corner) * corner.distance_m(to);
    side(from, corner, to).abs() <= 1e-6 * lengths && ahead < 0.0
}

/// Whether two edges without a shared corner meet.
fn meet((a, b): (Point2, Point2), (c, d): (Point2, Point2)) -> bool {
    let touches = |point: Point2, from: Point2, to: Point2| distance_to_edge_m(point, from, to) <= SAME_M;
    let (c_side, d_side) = (side(a, b, c), side(a, b, d));
    let (a_side, b_side) = (side(c, d, a), side(c, d, b));
    let is_across = c_side * d_side < 0.0 && a_side * b_side < 0.0;
    is_across || touches(c, a, b) || touches(d, a, b) || touches(a, c, d) || touches(b, c, d)
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
    fn outlines_that_cross_fold_or_touch_are_refused_by_name() {
        use EditError::{ZoneCrosses, ZoneTooThin};
        for (corners, refusal) in [
            (
                vec![(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)],
                Some(ZoneCrosses),
            ),
            // A spike, a corner on an edge, a star, the same corner again.
            (
                vec![(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0)],
                Some(ZoneCrosses),
            ),
            (
                vec![(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 0.0), (0.0, 2.0)],
                Some(ZoneCrosses),
            ),
            (
                vec![
                    (0.0, 1.0),
                    (0.59, -0.81),
                    (-0.95, 0.31),
                    (0.95, 0.31),
                    (-0.59, -0.81),
                ],
                Some(ZoneCrosses),
            ),
            (
                vec![(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0), (-1.0, 1.0)],
                Some(ZoneCrosses),
            ),
            (
                vec![(0.0, 0.0), (2.0, 0.0), (2.0, 0.003), (0.0, 0.003)],
                Some(ZoneTooThin),
            ),
            (vec![(1.0, 1.0), (1.0, 1.0), (2.0, 1.0)], Some(ZoneTooThin)),
            (
                vec![(0.0, 0.0), (0.05, 0.0), (0.05, 0.05), (0.0, 0.05)],
                Some(ZoneTooThin),
            ),
            // Corners that are pressed twice do no harm, nor does one in the middle of an edge.
            (
                vec![(0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0)],
                None,
            ),
            (
                vec![(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)],
                None,
            ),
        ] {
            let zone = Zone::new(corners.iter().map(|(x, y)| at(*x, *y)).collect());
            assert_eq!(zone.err(), refusal, "{corners:?}");
        }
    }

    #[test]
    fn a_stored_outline_that_crosses_has_no_hole() {
        let star = [
            (0.0, 1.0),
            (0.59, -0.81),
            (-0.95, 0.31),
            (0.95, 0.31),
            (-0.59, -0.81),
        ];
        let zone = Zone::of_stored(star.map(|(x, y)| at(x, y)).to_vec()).unwrap();
        assert!(zone.contains(at(0.0, 0.0)) && zone.contains(at(0.0, 0.9)));
        assert!(!zone.contains(at(0.9, 0.9)));
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
