//! The ground: where the body's middle can be, and what of the floor is still open.

use crate::mapping::{Cell, FloodFill, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;

/// A robot can set out to free cells this far from where it stands.
const SET_OUT_M: f64 = 0.4;
/// Work of asking whether a cell is done, of a row of a disc, of measuring the way to a cell, and of looking around one.
const CLOSE_WORK: usize = 1;
const FILL_WORK: usize = 6;
const MEASURE_WORK: usize = 6;
const VISIT_WORK: usize = 4;
/// Cells that are visited between two looks at the budget.
const VISITS: usize = 64;

/// Axis of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    /// Along rows, in x.
    X,
    /// Along columns, in y.
    Y,
}

impl Axis {
    pub(crate) const fn other(self) -> Self {
        match self {
            Self::X => Self::Y,
            Self::Y => Self::X,
        }
    }
}

/// Cells with a margin wide enough that no window around a free cell leaves the arrays.
#[derive(Clone, Debug)]
pub(crate) struct Ground {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Cells around the window on each side.
    margin: usize,
    origin: Cell,
    /// Cells to either side of a lane that it sweeps.
    pub(crate) reach: usize,
    /// The middle of the body can be here.
    pub(crate) free: Vec<bool>,
    /// Floor that can be swept and was not yet.
    pub(crate) open: Vec<bool>,
    /// Steps, diagonal ones too, from each cell to the nearest one that is not free; at most 255. Made by `keep_connected`.
    clearance: Vec<u8>,
}

impl Ground {
    pub(crate) async fn new(reachable: &Raster<bool>, reach: usize, budget: &mut StepBudget) -> Self {
        let margin = reach + 2;
        let (width, height) = (reachable.width() + 2 * margin, reachable.height() + 2 * margin);
        let mut ground = Self {
            width,
            height,
            margin,
            origin: reachable.origin(),
            reach,
            free: vec![false; width * height],
            open: vec![false; width * height],
            clearance: Vec::new(),
        };
        for (row, values) in reachable
            .values()
            .chunks_exact(reachable.width().max(1))
            .enumerate()
        {
            let start = (row + margin) * width + margin;
            if let Some(target) = ground.free.get_mut(start..start + values.len()) {
                target.copy_from_slice(values);
            }
        }
        budget.spend(width * height / 4).await;
        ground.open_floor(budget).await;
        ground
    }

    /// Cells along an axis.
    pub(crate) const fn length(&self, axis: Axis) -> usize {
        match axis {
            Axis::X => self.width,
            Axis::Y => self.height,
        }
    }

    /// Closes open floor that need not be swept.
    pub(crate) async fn close(&mut self, is_done: impl Fn(Cell) -> bool, budget: &mut StepBudget) {
        for row in 0..self.height {
            for index in row * self.width..(row + 1) * self.width {
                self.open[index] = self.open[index] && !is_done(self.cell(index));
            }
            budget.spend(CLOSE_WORK * self.width).await;
        }
    }

    /// Opens all floor within reach of free cells.
    async fn open_floor(&mut self, budget: &mut StepBudget) {
        let disc = self.disc();
        for index in 0..self.free.len() {
            if index.is_multiple_of(self.width) {
                budget.spend(self.width).await;
            }
            if !self.free[index] {
                continue;
            }
            // Inner cells are opened by their neighbours on the border too; only they themselves are needed.
            let inner = self
                .neighbours(index)
                .iter()
                .all(|neighbour| self.free[*neighbour]);
            if inner {
                self.open[index] = true;
                continue;
            }
            for (row, half) in &disc {
                let centre = self.shifted(index, *row);
                self.open[centre - half..=centre + half].fill(true);
            }
            budget.spend(FILL_WORK * disc.len()).await;
        }
    }

    /// Rows of a disc of the reach, and half the cells of each.
    pub(crate) fn disc(&self) -> Vec<(isize, usize)> {
        let radius = self.reach as f64 + 0.5;
        let reach = self.reach as isize;
        (-reach..=reach)
            .map(|row| {
                let rise = row as f64;
                (row, libm::sqrt(radius * radius - rise * rise) as usize)
            })
            .collect()
    }

    /// The index `rows` higher.
    pub(crate) fn shifted(&self, index: usize, rows: isize) -> usize {
        index.wrapping_add_signed(rows * self.width as isize)
    }

    pub(crate) fn neighbours(&self, index: usize) -> [usize; 4] {
        [index - 1, index + 1, index - self.width, index + self.width]
    }

    pub(crate) fn open_count(&self) -> usize {
        self.open.iter().filter(|open| **open).count()
    }

    /// Column and row of an index.
    pub(crate) fn place(&self, index: usize) -> (usize, usize) {
        (index % self.width, index / self.width)
    }

    /// The cell of the map at an index.
    pub(crate) fn cell(&self, index: usize) -> Cell {
        let (column, row) = self.place(index);
        Cell {
            x: self.origin.x.wrapping_add(column as i32 - self.margin as i32),
            y: self.origin.y.wrapping_add(row as i32 - self.margin as i32),
        }
    }

    /// Middle of the cell at an index.
    pub(crate) fn point(&self, index: usize) -> Point2 {
        self.cell(index).middle()
    }

    /// The free cell from which a robot at a point sets out: the nearest one of the largest ground if that is within its
    /// reach, else the nearest of all. A robot that has just met something often stands beside a splinter of free cells.
    pub(crate) async fn origin_near(&self, point: Point2, budget: &mut StepBudget) -> Option<usize> {
        let mut fill = FloodFill::over(self.free.len());
        let mut nearest: Option<(f64, usize)> = None;
        let mut largest: Option<(usize, f64, usize)> = None;
        for seed in 0..self.free.len() {
            if seed.is_multiple_of(self.width) {
                budget.spend(self.width).await;
            }
            if fill.has_reached(seed) || !self.free[seed] {
                continue;
            }
            let (size, distance_m, cell) = self.component(seed, &mut fill, (point, &mut *budget)).await;
            if nearest.is_none_or(|(least_m, _)| distance_m < least_m) {
                nearest = Some((distance_m, cell));
            }
            if distance_m < SET_OUT_M && largest.is_none_or(|(most, _, _)| size > most) {
                largest = Some((size, distance_m, cell));
            }
        }
        largest.map(|(_, _, cell)| cell).or(nearest.map(|(_, cell)| cell))
    }

    /// Size of a piece of connected ground, and its cell nearest to a point with the distance.
    async fn component(
        &self,
        seed: usize,
        fill: &mut FloodFill,
        (point, budget): (Point2, &mut StepBudget),
    ) -> (usize, f64, usize) {
        fill.reach(seed);
        let (mut size, mut best) = (0, (f64::INFINITY, seed));
        while let Some(index) = self.go_on(fill) {
            size += 1;
            if size % VISITS == 0 {
                budget.spend(MEASURE_WORK * VISITS).await;
            }
            let distance_m = self.point(index).distance_m(point);
            if distance_m < best.0 {
                best = (distance_m, index);
            }
        }
        (size, best.0, best.1)
    }

    /// Closes all ground that cannot be reached from a free cell, and the floor that only such ground could sweep.
    pub(crate) async fn keep_connected(&mut self, from: usize, budget: &mut StepBudget) {
        let mut fill = FloodFill::over(self.free.len());
        fill.reach(from);
        while !fill.is_done() {
            for _ in 0..VISITS {
                self.go_on(&mut fill);
            }
            budget.spend(VISIT_WORK * VISITS).await;
        }
        let reached = fill.into_reached();
        if reached != self.free {
            self.free = reached;
            self.open.fill(false);
            self.open_floor(budget).await;
        }
        self.measure_clearance(budget).await;
    }

    /// Goes on over free cells.
    fn go_on(&self, fill: &mut FloodFill) -> Option<usize> {
        fill.go_on(|index| self.neighbours(index), |index| self.free[index])
    }

    /// Two sweeps over the cells: from above and the left, then from below and the right.
    async fn measure_clearance(&mut self, budget: &mut StepBudget) {
        let width = self.width;
        self.clearance = self
            .free
            .iter()
            .map(|free| if *free { u8::MAX } else { 0 })
            .collect();
        let clearance = &mut self.clearance;
        for index in width + 1..clearance.len().saturating_sub(width + 1) {
            if index.is_multiple_of(width) {
                budget.spend(VISIT_WORK * width).await;
            }
            if clearance[index] > 0 {
                let before = [index - 1, index - width - 1, index - width, index - width + 1];
                let least = before.map(|neighbour| clearance[neighbour]).into_iter().min();
                clearance[index] = least.unwrap_or(0).saturating_add(1);
            }
        }
        for index in (width + 1..clearance.len().saturating_sub(width + 1)).rev() {
            if index.is_multiple_of(width) {
                budget.spend(VISIT_WORK * width).await;
            }
            if clearance[index] > 0 {
                let after = [index + 1, index + width + 1, index + width, index + width - 1];
                let least = after.map(|neighbour| clearance[neighbour]).into_iter().min();
                clearance[index] = clearance[index].min(least.unwrap_or(0).saturating_add(1));
            }
        }
    }

    /// Whether the straight way between two points leads over free cells only.
    pub(crate) fn sees_points(&self, from: Point2, to: Point2) -> bool {
        match (self.index_under(from), self.index_under(to)) {
            (Some(from), Some(to)) => self.free[from] && self.free[to] && self.sees(from, to),
            _ => false,
        }
    }

    /// The free cell under a point, if there is one.
    pub(crate) fn free_under(&self, point: Point2) -> Option<usize> {
        self.index_under(point).filter(|index| self.free[*index])
    }

    fn index_under(&self, point: Point2) -> Option<usize> {
        let cell = Cell::under(point);
        let margin = self.margin as i64;
        let column = i64::from(cell.x) - i64::from(self.origin.x) + margin;
        let row = i64::from(cell.y) - i64::from(self.origin.y) + margin;
        let inside = |place: i64, size: usize| (margin..size as i64 - margin).contains(&place);
        (inside(column, self.width) && inside(row, self.height))
            .then(|| row as usize * self.width + column as usize)
    }

    /// Whether the straight way between two free cells leads over free cells only.
    pub(crate) fn sees(&self, from: usize, to: usize) -> bool {
        let ((x0, y0), (x1, y1)) = (self.place(from), self.place(to));
        let (dx, dy) = (x1 as f64 - x0 as f64, y1 as f64 - y0 as f64);
        let steps = (2.0 * dx.abs().max(dy.abs())) as usize;
        let (step_x, step_y) = (dx / steps.max(1) as f64, dy / steps.max(1) as f64);
        let mut step = 0;
        while step < steps {
            let x = x0 as f64 + 0.5 + step as f64 * step_x;
            let y = y0 as f64 + 0.5 + step as f64 * step_y;
            let clearance = self.clearance[y as usize * self.width + x as usize];
            if clearance == 0 {
                return false;
            }
            // A step is half a cell; all cells nearer than the clearance are free.
            step += (2 * usize::from(clearance - 1)).max(1);
        }
        true
    }
}
