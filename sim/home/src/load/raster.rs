//! Polygons, strips and discs drawn into a grid: a cell belongs to a shape when its centre lies inside.

use crate::plan::{Cell, Grid};

/// Most corners of a polygon.
pub(crate) const CORNERS_MAX: usize = 1_000;

/// A grid to draw into.
pub(crate) struct Canvas<'a> {
    cell_m: f64,
    width: usize,
    height: usize,
    cells: &'a mut [Cell],
}

impl<'a> Canvas<'a> {
    pub(crate) fn of(grid: &'a mut Grid) -> Self {
        Self {
            cell_m: grid.cell_m,
            width: grid.width,
            height: grid.height,
            cells: &mut grid.cells,
        }
    }

    /// Calls `paint` with the cells and the index of each cell inside the polygon (even-odd rule), row by row.
    pub(crate) fn polygon(&mut self, corners: &[(f64, f64)], mut paint: impl FnMut(&mut [Cell], usize)) {
        let low = corners
            .iter()
            .map(|corner| corner.1)
            .fold(f64::INFINITY, f64::min);
        let high = corners
            .iter()
            .map(|corner| corner.1)
            .fold(f64::NEG_INFINITY, f64::max);
        let mut crossings = Vec::new();
        for row in self.span(low, high, self.height) {
            let y_m = (row as f64 + 0.5) * self.cell_m;
            crossings.clear();
            for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                if (a.1 <= y_m) != (b.1 <= y_m) {
                    crossings.push(a.0 + (y_m - a.1) / (b.1 - a.1) * (b.0 - a.0));
                }
            }
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                for column in self.span(pair[0], pair[1], self.width) {
                    paint(self.cells, row * self.width + column);
                }
            }
        }
    }

    /// The same for a straight strip of this width.
    pub(crate) fn strip(
        &mut self,
        ends: [(f64, f64); 2],
        width_m: f64,
        paint: impl FnMut(&mut [Cell], usize),
    ) {
        let [(ax, ay), (bx, by)] = ends;
        let length = libm::hypot(bx - ax, by - ay).max(1e-9);
        let (ux, uy) = (
            (bx - ax) / length * 0.5 * width_m,
            (by - ay) / length * 0.5 * width_m,
        );
        let corners = [
            (ax - uy, ay + ux),
            (ax + uy, ay - ux),
            (bx + uy, by - ux),
            (bx - uy, by + ux),
        ];
        self.polygon(&corners, paint);
    }

    /// The same for a disc; the cell around its centre always belongs to it, so that a thin leg does not vanish.
    pub(crate) fn disc(
        &mut self,
        centre: (f64, f64),
        radius_m: f64,
        mut paint: impl FnMut(&mut [Cell], usize),
    ) {
        for row in self.span(centre.1 - radius_m, centre.1 + radius_m, self.height) {
            let dy = (row as f64 + 0.5) * self.cell_m - centre.1;
            let half = libm::sqrt((radius_m * radius_m - dy * dy).max(0.0));
            for column in self.span(centre.0 - half, centre.0 + half, self.width) {
                paint(self.cells, row * self.width + column);
            }
        }
        let (column, row) = (centre.0 / self.cell_m, centre.1 / self.cell_m);
        if column >= 0.0 && row >= 0.0 && (column as usize) < self.width && (row as usize) < self.height {
            paint(self.cells, row as usize * self.width + column as usize);
        }
    }

    /// Rows or columns whose centre lies within `from..to` metres.
    fn span(&self, from: f64, to: f64, limit: usize) -> core::ops::Range<usize> {
        // `as` saturates, so a far away shape becomes an empty span.
        let first = libm::ceil(from / self.cell_m - 0.5).max(0.0) as usize;
        let end = (libm::ceil(to / self.cell_m - 0.5).max(0.0) as usize).min(limit);
        first.min(end)..end
    }
}

#[cfg(test)]
mod tests {
    use super::Canvas;
    use crate::plan::{Cell, Grid};

    fn blank() -> Grid {
        Grid {
            cell_m: 0.02,
            width: 100,
            height: 100,
            cells: vec![Cell::Outside; 10_000],
        }
    }

    fn floor(cells: &mut [Cell], index: usize) {
        cells[index] = Cell::Floor;
    }

    fn painted_m2(grid: &Grid) -> f64 {
        grid.cells.iter().filter(|cell| **cell == Cell::Floor).count() as f64 * grid.cell_area_m2()
    }

    #[test]
    fn shapes_have_their_areas() {
        let mut grid = blank();
        Canvas::of(&mut grid).polygon(&[(0.2, 0.2), (1.2, 0.2), (1.2, 0.7), (0.2, 0.7)], floor);
        assert!((painted_m2(&grid) - 0.5).abs() < 1e-9);

        let mut grid = blank();
        Canvas::of(&mut grid).disc((1.0, 1.0), 0.5, floor);
        assert!((painted_m2(&grid) - 0.785).abs() < 0.01);

        let mut grid = blank();
        Canvas::of(&mut grid).strip([(0.2, 0.3), (1.2, 1.0)], 0.2, floor);
        let strip_m2 = painted_m2(&grid);
        assert!((strip_m2 - 0.244).abs() < 0.005, "{strip_m2}");
    }

    #[test]
    fn shapes_far_outside_paint_nothing() {
        let mut grid = blank();
        Canvas::of(&mut grid).polygon(&[(-9e9, -9e9), (-8e9, -9e9), (-8e9, -8e9)], floor);
        Canvas::of(&mut grid).disc((1e12, 0.0), 1.0, floor);
        assert_eq!(painted_m2(&grid), 0.0);
    }
}
