//! A dense window of cells.

use super::Cell;

/// Cells that are looked at between two looks at the budget.
pub(super) const CELLS: usize = 128;

/// Values of the cells of a rectangle whose lower left cell is `origin`; rows from low to high y.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Raster<T> {
    origin: Cell,
    width: usize,
    values: Vec<T>,
}

impl<T: Clone> Raster<T> {
    /// A window of `width` times `height` cells that all hold `value`.
    #[must_use]
    pub fn filled(origin: Cell, width: usize, height: usize, value: T) -> Self {
        Self {
            origin,
            width,
            values: vec![value; width.saturating_mul(height)],
        }
    }
}

impl<T: Copy> Raster<T> {
    /// Takes over the values of another window where both have cells.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        let low = i64::from(other.origin.x) - i64::from(self.origin.x);
        let (first, end) = (low.max(0), (low + other.width as i64).min(self.width as i64));
        for (row, values) in other.values.chunks_exact(other.width.max(1)).enumerate() {
            let y = other
                .origin
                .y
                .saturating_add(i32::try_from(row).unwrap_or(i32::MAX));
            let start = self.index(Cell { x: self.origin.x, y });
            if let Some(start) = start
                && first < end
            {
                let target = start + first as usize..start + end as usize;
                let source = (first - low) as usize..(end - low) as usize;
                if let (Some(target), Some(source)) = (self.values.get_mut(target), values.get(source)) {
                    target.copy_from_slice(source);
                }
            }
        }
    }
}

impl<T> Raster<T> {
    /// The lower left cell.
    #[must_use]
    pub const fn origin(&self) -> Cell {
        self.origin
    }

    /// Cells of a row.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.values.len().checked_div(self.width).unwrap_or(0)
    }

    /// All values, row after row.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// All values, row after row.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// The value of a cell; `None` outside.
    #[must_use]
    pub fn get(&self, cell: Cell) -> Option<&T> {
        self.values.get(self.index(cell)?)
    }

    /// The value of a cell, to be changed; `None` outside.
    pub fn get_mut(&mut self, cell: Cell) -> Option<&mut T> {
        let index = self.index(cell)?;
        self.values.get_mut(index)
    }

    /// Place of a cell among [`Self::values`]; `None` outside.
    #[must_use]
    pub fn index(&self, cell: Cell) -> Option<usize> {
        let column = usize::try_from(i64::from(cell.x) - i64::from(self.origin.x)).ok()?;
        let row = usize::try_from(i64::from(cell.y) - i64::from(self.origin.y)).ok()?;
        // Not compared with the height: that is a division, which a Pi Zero has no instruction for.
        let index = row.checked_mul(self.width)?.checked_add(column)?;
        (column < self.width && index < self.values.len()).then_some(index)
    }

    /// The cell at a place of [`Self::values`].
    #[must_use]
    pub fn cell(&self, index: usize) -> Cell {
        let (row, column) = (
            index.checked_div(self.width).unwrap_or(0),
            index.checked_rem(self.width).unwrap_or(0),
        );
        Cell {
            x: self
                .origin
                .x
                .saturating_add(i32::try_from(column).unwrap_or(i32::MAX)),
            y: self
                .origin
                .y
                .saturating_add(i32::try_from(row).unwrap_or(i32::MAX)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Raster;
    use crate::mapping::Cell;

    #[test]
    fn a_window_takes_over_what_it_shares_with_another_one() {
        let mut source = Raster::filled(Cell { x: 0, y: 0 }, 3, 3, 1_u8);
        *source.get_mut(Cell { x: 1, y: 2 }).unwrap() = 7;
        for (x, y) in [(-1, -1), (1, 1), (0, 2), (-5, 1), (2, -2), (9, 9)] {
            let mut target = Raster::filled(Cell { x, y }, 4, 4, 0_u8);
            target.copy_from(&source);
            for index in 0..target.values().len() {
                let expected = source.get(target.cell(index)).copied().unwrap_or(0);
                assert_eq!(target.values()[index], expected, "{x} {y} {index}");
            }
        }
    }

    #[test]
    fn cells_inside_are_found_and_those_outside_are_not() {
        let mut raster = Raster::filled(Cell { x: -2, y: 5 }, 4, 3, 0_u8);
        *raster.get_mut(Cell { x: 1, y: 7 }).unwrap() = 9;
        assert_eq!(raster.get(Cell { x: 1, y: 7 }), Some(&9));
        assert_eq!(raster.index(Cell { x: 1, y: 7 }), Some(11));
        assert_eq!(raster.cell(11), Cell { x: 1, y: 7 });
        for outside in [(-3, 5), (2, 5), (0, 4), (0, 8), (i32::MIN, i32::MAX)] {
            assert_eq!(
                raster.get(Cell {
                    x: outside.0,
                    y: outside.1
                }),
                None
            );
        }
    }
}
