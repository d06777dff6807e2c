//! Cells of zones and rectangles.

use super::Cell;
use super::occupancy_grid::CellBox;
use crate::model::geometry::Point2;
use crate::model::zone::Zone;

/// Cells of `window` whose centres lie in a zone, row after row.
pub(super) fn cells_of(zone: &Zone, window: CellBox) -> impl Iterator<Item = Cell> + '_ {
    cells_around(zone, window).filter(|cell| zone.contains(cell.middle()))
}

/// Cells of `window` in the bounding box of a zone, row after row.
pub(super) fn cells_around(zone: &Zone, window: CellBox) -> impl Iterator<Item = Cell> + use<> {
    let (low, high) = around(zone);
    cells_between(low, high, window)
}

/// Cells of a rectangle within `window`, row after row.
pub(super) fn cells_between(
    low: Point2,
    high: Point2,
    window: CellBox,
) -> impl Iterator<Item = Cell> + use<> {
    let (low, high) = (Cell::under(low), Cell::under(high));
    let columns = low.x.max(window.low.x)..=high.x.min(window.high.x);
    let rows = low.y.max(window.low.y)..=high.y.min(window.high.y);
    rows.flat_map(move |y| columns.clone().map(move |x| Cell { x, y }))
}

/// Bounding box of a zone.
fn around(zone: &Zone) -> (Point2, Point2) {
    let first = zone.corners().first().copied().unwrap_or_default();
    zone.corners().iter().fold((first, first), |(low, high), corner| {
        let low = Point2 {
            x_m: low.x_m.min(corner.x_m),
            y_m: low.y_m.min(corner.y_m),
        };
        let high = Point2 {
            x_m: high.x_m.max(corner.x_m),
            y_m: high.y_m.max(corner.y_m),
        };
        (low, high)
    })
}
