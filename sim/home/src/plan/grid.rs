//! Cells of a floor plan.

/// What a cell is. The numbers are those that drawings of the plan use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Cell {
    /// Unknown or outside the home: solid.
    #[default]
    Outside = 0,
    /// Hard floor.
    Floor = 1,
    /// Wall, closed door or furniture: solid.
    Obstacle = 2,
    /// No floor: stairs, an edge.
    Cliff = 3,
    /// Floor under a rug.
    Rug = 4,
}

impl Cell {
    /// The body cannot be there.
    #[must_use]
    pub const fn is_solid(self) -> bool {
        matches!(self, Self::Outside | Self::Obstacle)
    }

    /// A wheel can roll there.
    #[must_use]
    pub const fn is_floor(self) -> bool {
        matches!(self, Self::Floor | Self::Rug)
    }
}

/// A grid of cells in the plan frame: x to the right, y up, the origin at the lower left corner of cell (0, 0).
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Metres per cell.
    pub cell_m: f64,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row from the lowest y, each from the lowest x.
    pub cells: Vec<Cell>,
}

impl Grid {
    /// The cell at a place in metres; outside of the grid it is [`Cell::Outside`].
    #[must_use]
    pub fn at(&self, x_m: f64, y_m: f64) -> Cell {
        self.index(x_m, y_m)
            .and_then(|index| self.cells.get(index).copied())
            .unwrap_or_default()
    }

    /// Index of the cell at a place in metres.
    #[must_use]
    pub fn index(&self, x_m: f64, y_m: f64) -> Option<usize> {
        if x_m < 0.0 || y_m < 0.0 {
            return None;
        }
        let (column, row) = ((x_m / self.cell_m) as usize, (y_m / self.cell_m) as usize);
        (column < self.width && row < self.height).then(|| row * self.width + column)
    }

    /// Centre of a cell in metres.
    #[must_use]
    pub fn centre(&self, index: usize) -> (f64, f64) {
        let width = self.width.max(1);
        let (column, row) = (index % width, index / width);
        (
            (column as f64 + 0.5) * self.cell_m,
            (row as f64 + 0.5) * self.cell_m,
        )
    }

    /// Area of one cell, square metres.
    #[must_use]
    pub fn cell_area_m2(&self) -> f64 {
        self.cell_m * self.cell_m
    }
}
