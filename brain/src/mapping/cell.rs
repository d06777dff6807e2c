//! The unit of all grids of the map.

use crate::model::geometry::Point2;

/// Edge of a cell in metres.
pub const CELL_M: f64 = 0.025;

/// Integer coordinates of a cell: it spans `x * CELL_M` to `(x + 1) * CELL_M`, likewise in y.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cell {
    /// Column.
    pub x: i32,
    /// Row.
    pub y: i32,
}

impl Cell {
    /// The cell under a point.
    #[must_use]
    pub fn under(point: Point2) -> Self {
        Self {
            x: index(point.x_m),
            y: index(point.y_m),
        }
    }

    /// The centre of the cell.
    #[must_use]
    pub fn middle(self) -> Point2 {
        Point2 {
            x_m: (f64::from(self.x) + 0.5) * CELL_M,
            y_m: (f64::from(self.y) + 0.5) * CELL_M,
        }
    }
}

/// Column or row of a coordinate.
pub(super) fn index(coordinate_m: f64) -> i32 {
    libm::floor(coordinate_m / CELL_M) as i32
}

/// The four neighbours: right, above, left and below.
pub(super) fn neighbours(cell: Cell) -> [Cell; 4] {
    [(1, 0), (0, 1), (-1, 0), (0, -1)].map(|(x, y)| Cell {
        x: cell.x.saturating_add(x),
        y: cell.y.saturating_add(y),
    })
}
