//! Simplifies chains of cells to corners (Ramer-Douglas-Peucker).

use crate::coverage::plan::parameters::RINGS;
use crate::model::geometry::Point2;
use crate::navigation::configuration_space::ConfigurationSpace;

/// The corner cells of a chain, both ends included. The straight lines between them pass over free cells only.
pub(super) fn corners(space: &ConfigurationSpace, cells: &[usize]) -> Vec<usize> {
    let Some(last) = cells.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut kept = vec![cells[0]];
    let mut parts = vec![(0, last)];
    while let Some((from, to)) = parts.pop() {
        let (off_m, place) = farthest(space, cells, from, to);
        let is_straight = off_m <= RINGS.off_max_m && space.has_line_of_sight(cells[from], cells[to]);
        if is_straight || to <= from + 1 {
            kept.push(cells[to]);
        } else {
            parts.extend([(place, to), (from, place)]);
        }
    }
    kept
}

/// The cell that lies farthest from the straight line between two others, and its distance. Among equals the one nearest to
/// the middle wins, which halves the chain fastest.
fn farthest(space: &ConfigurationSpace, cells: &[usize], from: usize, to: usize) -> (f64, usize) {
    let middle = from.midpoint(to);
    let (start, end) = (space.point(cells[from]), space.point(cells[to]));
    let mut farthest = (0.0, middle);
    for (place, cell) in cells.iter().enumerate().take(to).skip(from + 1) {
        let off_m = off_m(space.point(*cell), start, end);
        let is_nearer = place.abs_diff(middle) < farthest.1.abs_diff(middle);
        if off_m > farthest.0 || off_m >= farthest.0 && is_nearer {
            farthest = (off_m, place);
        }
    }
    farthest
}

/// Distance of a point from the straight line between two others.
fn off_m(point: Point2, from: Point2, to: Point2) -> f64 {
    let (along_x, along_y) = (to.x_m - from.x_m, to.y_m - from.y_m);
    let square = along_x * along_x + along_y * along_y;
    if square <= 0.0 {
        return point.distance_m(from);
    }
    let (x, y) = (point.x_m - from.x_m, point.y_m - from.y_m);
    (along_x * y - along_y * x).abs() / libm::sqrt(square)
}
