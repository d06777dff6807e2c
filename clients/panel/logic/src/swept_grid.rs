//! The swept cells as a picture that grows.

/// Cells are added to the picture in blocks of this many.
const BLOCK: i32 = 64;

/// The picture never gets wider or higher: cells beyond are not shown. At 5 cm a cell this is 200 m.
const SIDE_MAX: i32 = 4096;

/// Rows that changed since they were last taken, `first..end`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DirtyRows {
    /// First row.
    pub first: u32,
    /// One past the last row.
    pub end: u32,
}

/// One byte a cell, 255 = swept, row by row from the lowest y.
#[derive(Clone, Debug, Default)]
pub struct SweptGrid {
    x0: i32,
    y0: i32,
    width: i32,
    height: i32,
    bytes: Vec<u8>,
    dirty: Option<DirtyRows>,
    resized: bool,
}

impl SweptGrid {
    /// Cell coordinates of the lower left cell.
    #[must_use]
    pub const fn origin(&self) -> (i32, i32) {
        (self.x0, self.y0)
    }

    /// Columns and rows.
    #[must_use]
    pub const fn size(&self) -> (i32, i32) {
        (self.width, self.height)
    }

    /// The cells.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The cells of some rows.
    #[must_use]
    pub fn rows(&self, rows: DirtyRows) -> &[u8] {
        let width = self.width as usize;
        self.bytes
            .get(rows.first as usize * width..rows.end as usize * width)
            .unwrap_or_default()
    }

    /// Forgets all cells.
    pub fn clear(&mut self) {
        *self = Self {
            resized: true,
            ..Self::default()
        };
    }

    /// Marks cells given as `[ix0, iy0, ix1, iy1, ...]`.
    pub fn mark_all(&mut self, cells: &[i32]) {
        for cell in cells.chunks_exact(2) {
            if let &[ix, iy] = cell {
                self.mark(ix, iy);
            }
        }
    }

    /// Whether the picture changed its size since this was last asked: then all of it must be taken anew.
    pub fn take_resized(&mut self) -> bool {
        let resized = std::mem::take(&mut self.resized);
        if resized {
            self.dirty = None;
        }
        resized
    }

    /// The rows that changed since this was last asked.
    pub fn take_dirty(&mut self) -> Option<DirtyRows> {
        self.dirty.take()
    }

    fn mark(&mut self, ix: i32, iy: i32) {
        if !self.holds(ix, iy) && !self.grow_to(ix, iy) {
            return;
        }
        let row = iy - self.y0;
        let index = row as usize * self.width as usize + (ix - self.x0) as usize;
        if let Some(byte) = self.bytes.get_mut(index) {
            *byte = 255;
        }
        let row = row as u32;
        let dirty = self.dirty.unwrap_or(DirtyRows {
            first: row,
            end: row + 1,
        });
        self.dirty = Some(DirtyRows {
            first: dirty.first.min(row),
            end: dirty.end.max(row + 1),
        });
    }

    const fn holds(&self, ix: i32, iy: i32) -> bool {
        ix >= self.x0 && iy >= self.y0 && ix - self.x0 < self.width && iy - self.y0 < self.height
    }

    /// Makes room for a cell; false when it lies too far away.
    fn grow_to(&mut self, ix: i32, iy: i32) -> bool {
        if ix.unsigned_abs() > SIDE_MAX.unsigned_abs() || iy.unsigned_abs() > SIDE_MAX.unsigned_abs() {
            return false;
        }
        let floor = |cell: i32| cell.div_euclid(BLOCK) * BLOCK;
        let (mut x0, mut y0, mut x1, mut y1) = (floor(ix), floor(iy), floor(ix) + BLOCK, floor(iy) + BLOCK);
        if self.width > 0 {
            x0 = x0.min(self.x0);
            y0 = y0.min(self.y0);
            x1 = x1.max(self.x0 + self.width);
            y1 = y1.max(self.y0 + self.height);
        }
        if x1 - x0 > SIDE_MAX || y1 - y0 > SIDE_MAX {
            return false;
        }
        self.move_into(x0, y0, (x1 - x0, y1 - y0));
        true
    }

    fn move_into(&mut self, x0: i32, y0: i32, (width, height): (i32, i32)) {
        let mut bytes = vec![0; width as usize * height as usize];
        if self.width > 0 {
            for (row, old) in self.bytes.chunks_exact(self.width as usize).enumerate() {
                let at = (row + (self.y0 - y0) as usize) * width as usize + (self.x0 - x0) as usize;
                if let Some(target) = bytes.get_mut(at..at + old.len()) {
                    target.copy_from_slice(old);
                }
            }
        }
        *self = Self {
            x0,
            y0,
            width,
            height,
            bytes,
            dirty: None,
            resized: true,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::{DirtyRows, SweptGrid};

    fn is_swept(grid: &SweptGrid, ix: i32, iy: i32) -> bool {
        let (x0, y0) = grid.origin();
        let (width, height) = grid.size();
        assert!((0..width).contains(&(ix - x0)) && (0..height).contains(&(iy - y0)));
        grid.bytes()[((iy - y0) * width + ix - x0) as usize] == 255
    }

    #[test]
    fn cells_survive_growth_in_every_direction() {
        let mut grid = SweptGrid::default();
        let cells = [[0, 0], [-1, -1], [500, 3], [-300, 200], [64, -65]];
        for cell in cells {
            grid.mark_all(&cell);
        }
        for [ix, iy] in cells {
            assert!(is_swept(&grid, ix, iy), "{ix} {iy}");
        }
        assert_eq!(
            grid.bytes().iter().filter(|byte| **byte == 255).count(),
            cells.len()
        );
    }

    #[test]
    fn changes_are_told_once() {
        let mut grid = SweptGrid::default();
        grid.mark_all(&[3, 5]);
        assert!(grid.take_resized());
        assert_eq!(grid.take_dirty(), None);
        grid.mark_all(&[1, 7, 1, 9]);
        assert!(!grid.take_resized());
        assert_eq!(grid.take_dirty(), Some(DirtyRows { first: 7, end: 10 }));
        assert_eq!(grid.take_dirty(), None);
    }

    #[test]
    fn a_cell_at_the_end_of_the_world_costs_no_memory() {
        let mut grid = SweptGrid::default();
        grid.mark_all(&[i32::MAX, i32::MIN, 0, 0, 4000, 0, -4000, 0]);
        assert!(grid.bytes().len() < 1 << 20, "{}", grid.bytes().len());
        assert!(is_swept(&grid, 0, 0));
    }

    #[test]
    fn an_odd_number_at_the_end_is_ignored() {
        let mut grid = SweptGrid::default();
        grid.mark_all(&[1, 2, 3]);
        assert_eq!(grid.bytes().iter().filter(|byte| **byte == 255).count(), 1);
    }
}
