//! The swept cells as a picture that grows.

use crate::swept_chance::{Levels, chances, level, reach};

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

/// One byte a cell, 255 = surely swept, row by row from the lowest y.
#[derive(Clone, Debug, Default)]
pub struct SweptGrid {
    x0: i32,
    y0: i32,
    width: i32,
    height: i32,
    bytes: Vec<u8>,
    /// How sure the robot was of its place when it swept, see [`level`].
    levels: Vec<u8>,
    /// Reach of the least sure cell.
    reach: i32,
    dirty: Option<DirtyRows>,
    resized: bool,
}

/// Cells from one corner to the other, both included.
#[derive(Clone, Copy, Debug)]
struct Span {
    low: (i32, i32),
    high: (i32, i32),
}

impl Span {
    fn with(self, ix: i32, iy: i32) -> Self {
        Self {
            low: (self.low.0.min(ix), self.low.1.min(iy)),
            high: (self.high.0.max(ix), self.high.1.max(iy)),
        }
    }

    const fn grown(self, cells: i32) -> Self {
        Self {
            low: (self.low.0 - cells, self.low.1 - cells),
            high: (self.high.0 + cells, self.high.1 + cells),
        }
    }
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

    /// Marks cells given as `[ix0, iy0, ix1, iy1, ...]`, with their deviations as `[n0, s0, n1, s1, ...]`, see
    /// [`rvac_api::MapSnapshot`].
    pub fn mark_all(&mut self, cells: &[i32], sigma: &[u32], cell_m: f64) {
        let told = sigma.chunks_exact(2).flat_map(|run| {
            let (count, sigma_cm) = (run[0], run[1]);
            std::iter::repeat_n(level(0.01 * f64::from(sigma_cm)), count as usize)
        });
        let levels = told.chain(std::iter::repeat(level(0.0)));
        let mut changed: Option<Span> = None;
        for (cell, level) in cells.chunks_exact(2).zip(levels) {
            if let &[ix, iy] = cell
                && self.mark(ix, iy, level)
            {
                let point = Span {
                    low: (ix, iy),
                    high: (ix, iy),
                };
                changed = Some(changed.map_or(point, |span| span.with(ix, iy)));
                self.reach = self.reach.max(reach(level, cell_m));
            }
        }
        if let Some(span) = changed {
            self.shade(span.grown(self.reach), cell_m);
        }
    }

    /// Computes the chances of some cells again.
    fn shade(&mut self, span: Span, cell_m: f64) {
        self.make_room(span);
        let target = self.clipped(span);
        let source = self.clipped(target.grown(self.reach));
        let width = (source.high.0 - source.low.0 + 1) as usize;
        let cells: Vec<u8> = (source.low.1..=source.high.1)
            .flat_map(|iy| {
                let from = self.index(source.low.0, iy);
                self.levels.get(from..from + width).unwrap_or_default()
            })
            .copied()
            .collect();
        let window = Levels { cells: &cells, width };
        let chances = chances(window, cell_m);
        let target_width = (target.high.0 - target.low.0 + 1) as usize;
        for iy in target.low.1..=target.high.1 {
            let row = (iy - source.low.1) as usize * width + (target.low.0 - source.low.0) as usize;
            let to = self.index(target.low.0, iy);
            let fresh = chances.get(row..row + target_width);
            if let (Some(fresh), Some(old)) = (fresh, self.bytes.get_mut(to..to + target_width)) {
                old.copy_from_slice(fresh);
            }
        }
        self.touch_rows(target);
    }

    /// Chances reach beyond what was swept, as far as the picture can grow.
    fn make_room(&mut self, Span { low, high }: Span) {
        for (ix, iy) in [low, high] {
            if !self.holds(ix, iy) {
                self.grow_to(ix, iy);
            }
        }
    }

    fn clipped(&self, Span { low, high }: Span) -> Span {
        let (last_x, last_y) = (self.x0 + self.width - 1, self.y0 + self.height - 1);
        Span {
            low: (low.0.max(self.x0), low.1.max(self.y0)),
            high: (high.0.min(last_x), high.1.min(last_y)),
        }
    }

    const fn index(&self, ix: i32, iy: i32) -> usize {
        (iy - self.y0) as usize * self.width as usize + (ix - self.x0) as usize
    }

    fn touch_rows(&mut self, Span { low, high }: Span) {
        let (first, end) = ((low.1 - self.y0) as u32, (high.1 - self.y0 + 1) as u32);
        let dirty = self.dirty.unwrap_or(DirtyRows { first, end });
        self.dirty = Some(DirtyRows {
            first: dirty.first.min(first),
            end: dirty.end.max(end),
        });
    }

    /// Whether the picture changed its size since this was last asked: then all of it must be taken again.
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

    /// `false` for a cell that is too far away.
    fn mark(&mut self, ix: i32, iy: i32, level: u8) -> bool {
        if !self.holds(ix, iy) && !self.grow_to(ix, iy) {
            return false;
        }
        let index = self.index(ix, iy);
        if let Some(known) = self.levels.get_mut(index) {
            *known = level;
        }
        true
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
        self.move_into([x0, y0], [x1 - x0, y1 - y0]);
        true
    }

    fn move_into(&mut self, [x0, y0]: [i32; 2], [width, height]: [i32; 2]) {
        let moved = |cells: &[u8]| {
            let mut larger = vec![0; width as usize * height as usize];
            for (row, old) in cells.chunks_exact((self.width as usize).max(1)).enumerate() {
                let at = (row + (self.y0 - y0) as usize) * width as usize + (self.x0 - x0) as usize;
                if let Some(target) = larger.get_mut(at..at + old.len()) {
                    target.copy_from_slice(old);
                }
            }
            larger
        };
        *self = Self {
            x0,
            y0,
            width,
            height,
            bytes: moved(&self.bytes),
            levels: moved(&self.levels),
            reach: self.reach,
            dirty: None,
            resized: true,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::{DirtyRows, SweptGrid};

    const CELL_M: f64 = 0.025;

    fn byte(grid: &SweptGrid, ix: i32, iy: i32) -> u8 {
        let ((x0, y0), (width, _)) = (grid.origin(), grid.size());
        grid.bytes()[((iy - y0) * width + ix - x0) as usize]
    }

    #[test]
    fn what_was_swept_by_an_unsure_robot_is_paler_and_wider_and_grows_as_if_received_at_once() {
        let cells: Vec<i32> = (0..400).flat_map(|index| [index % 20, index / 20]).collect();
        let mut at_once = SweptGrid::default();
        at_once.mark_all(&cells, &[400, 12], CELL_M);
        let edge = byte(&at_once, 0, 10);
        assert!((90..165).contains(&edge), "{edge}");
        assert!(byte(&at_once, -4, 10) > 20, "it may have swept there, too");
        assert!(byte(&at_once, 10, 10) > 230);
        let mut by_and_by = SweptGrid::default();
        for part in cells.chunks(80) {
            by_and_by.mark_all(part, &[40, 12], CELL_M);
        }
        for (ix, iy) in [(0, 10), (-4, 10), (10, 10), (19, 19), (10, 3), (10, 4)] {
            let apart = i32::from(byte(&at_once, ix, iy)) - i32::from(byte(&by_and_by, ix, iy));
            assert!(apart.abs() <= 1, "{ix} {iy}: {apart}");
        }
    }

    #[test]
    fn deviations_belong_to_their_cells_and_what_is_not_reported_is_sure() {
        let mut grid = SweptGrid::default();
        grid.mark_all(&[0, 0, 100, 0, 200, 0], &[1, 0, 1, 25], CELL_M);
        assert_eq!((byte(&grid, 0, 0), byte(&grid, 200, 0)), (255, 255));
        assert!(byte(&grid, 100, 0) < 20, "one cell of a robot that knows little");
    }

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
            grid.mark_all(&cell, &[], CELL_M);
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
    fn changes_are_reported_once() {
        let mut grid = SweptGrid::default();
        grid.mark_all(&[3, 5], &[], CELL_M);
        assert!(grid.take_resized());
        assert_eq!(grid.take_dirty(), None);
        grid.mark_all(&[1, 7, 1, 9], &[], CELL_M);
        assert!(!grid.take_resized());
        assert_eq!(grid.take_dirty(), Some(DirtyRows { first: 7, end: 10 }));
        assert_eq!(grid.take_dirty(), None);
    }

    #[test]
    fn a_cell_at_the_end_of_the_world_costs_no_memory() {
        let mut grid = SweptGrid::default();
        grid.mark_all(&[i32::MAX, i32::MIN, 0, 0, 4000, 0, -4000, 0], &[], CELL_M);
        assert!(grid.bytes().len() < 1 << 20, "{}", grid.bytes().len());
        assert!(is_swept(&grid, 0, 0));
    }

    #[test]
    fn an_odd_number_at_the_end_is_ignored() {
        let mut grid = SweptGrid::default();
        grid.mark_all(&[1, 2, 3], &[], CELL_M);
        assert_eq!(grid.bytes().iter().filter(|byte| **byte == 255).count(), 1);
    }
}
