//! The configuration space: where the robot's centre can be, and which floor is still open.

use crate::mapping::{Cell, FloodFill, Raster};
use crate::model::geometry::Point2;
use crate::model::gradual::StepBudget;

/// Distance within which a robot may enter the free cells, metres.
const SET_OUT_M: f64 = 0.4;
/// Work to ask whether a cell is done, of a row of a disc, to measure the distance to a cell, and to visit its neighbours.
const CLOSE_WORK: usize = 1;
const FILL_WORK: usize = 6;
const MEASURE_WORK: usize = 6;
const VISIT_WORK: usize = 4;
/// Cells that are visited between two checks of the budget.
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

/// A grid with a margin wide enough that no disc around a free cell leaves the arrays.
#[derive(Clone, Debug)]
pub(crate) struct ConfigurationSpace {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Margin around the window on each side, cells.
    margin: usize,
    origin: Cell,
    /// Cells on either side of a lane that it sweeps.
    pub(crate) reach: usize,
    /// The robot's centre can be here.
    pub(crate) free: Vec<bool>,
    /// Floor that can be swept and is not yet.
    pub(crate) open: Vec<bool>,
    /// Steps, diagonal ones included, from each cell to the nearest one that is not free; at most 255. `keep_connected`
    /// computes them.
    clearance: Vec<u8>,
}

/// A connected component of the free cells, seen from a point.
struct Component {
    /// Number of cells.
    size: usize,
    /// Distance from the point to its nearest cell, metres.
    distance_m: f64,
    /// Index of that cell.
    nearest: usize,
}

impl ConfigurationSpace {
    pub(crate) async fn new(reachable: &Raster<bool>, reach: usize, budget: &mut StepBudget) -> Self {
        let margin = reach + 2;
        let (width, height) = (reachable.width() + 2 * margin, reachable.height() + 2 * margin);
        let mut space = Self {
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
            if let Some(target) = space.free.get_mut(start..start + values.len()) {
                target.copy_from_slice(values);
            }
        }
        budget.spend(width * height / 4).await;
        space.open_floor(budget).await;
        space
    }

    /// Number of cells along an axis.
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
            // The discs of cells on the border cover the neighbours of inner cells, which therefore only open themselves.
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

    /// Rows of a disc with the radius of the reach, and half the width of each.
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
    pub(crate) fn column_and_row(&self, index: usize) -> (usize, usize) {
        (index % self.width, index / self.width)
    }

    /// The cell of the map at an index.
    pub(crate) fn cell(&self, index: usize) -> Cell {
        let (column, row) = self.column_and_row(index);
        Cell {
            x: self.origin.x.wrapping_add(column as i32 - self.margin as i32),
            y: self.origin.y.wrapping_add(row as i32 - self.margin as i32),
        }
    }

    /// Centre of the cell at an index.
    pub(crate) fn point(&self, index: usize) -> Point2 {
        self.cell(index).middle()
    }

    /// The free cell from which a robot at a point sets out: the nearest one of the largest component within reach,
    /// otherwise the nearest of all. After a contact a robot often stands beside a small isolated group of free cells.
    pub(crate) async fn origin_near(&self, point: Point2, budget: &mut StepBudget) -> Option<usize> {
        let mut fill = FloodFill::over(self.free.len());
        let mut closest: Option<(f64, usize)> = None;
        let mut largest: Option<(usize, usize)> = None;
        for seed in 0..self.free.len() {
            if seed.is_multiple_of(self.width) {
                budget.spend(self.width).await;
            }
            if fill.has_reached(seed) || !self.free[seed] {
                continue;
            }
            fill.reach(seed);
            let Component {
                size,
                distance_m,
                nearest,
            } = self.component(&mut fill, point, budget).await;
            if closest.is_none_or(|(least_m, _)| distance_m < least_m) {
                closest = Some((distance_m, nearest));
            }
            if distance_m < SET_OUT_M && largest.is_none_or(|(most, _)| size > most) {
                largest = Some((size, nearest));
            }
        }
        largest.map(|(_, cell)| cell).or(closest.map(|(_, cell)| cell))
    }

    /// Measures the component that a flood fill has just entered.
    async fn component(&self, fill: &mut FloodFill, point: Point2, budget: &mut StepBudget) -> Component {
        let mut component = Component {
            size: 0,
            distance_m: f64::INFINITY,
            nearest: 0,
        };
        while let Some(index) = self.go_on(fill) {
            component.size += 1;
            if component.size.is_multiple_of(VISITS) {
                budget.spend(MEASURE_WORK * VISITS).await;
            }
            let distance_m = self.point(index).distance_m(point);
            if component.size == 1 || distance_m < component.distance_m {
                component.distance_m = distance_m;
                component.nearest = index;
            }
        }
        component
    }

    /// Removes all cells that are not reachable from a free cell, and the floor that only they could sweep.
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

    /// Continues a flood fill over free cells.
    fn go_on(&self, fill: &mut FloodFill) -> Option<usize> {
        fill.go_on(|index| self.neighbours(index), |index| self.free[index])
    }

    /// Chebyshev distance transform in two scans: from above and the left, then from below and the right.
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

    /// Whether the straight line between two points passes over free cells only.
    pub(crate) fn has_line_of_sight_between(&self, from: Point2, to: Point2) -> bool {
        match (self.index_under(from), self.index_under(to)) {
            (Some(from), Some(to)) => self.free[from] && self.free[to] && self.has_line_of_sight(from, to),
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
        let inside = |position: i64, size: usize| (margin..size as i64 - margin).contains(&position);
        (inside(column, self.width) && inside(row, self.height))
            .then(|| row as usize * self.width + column as usize)
    }

    /// Whether the straight line between two free cells passes over free cells only.
    pub(crate) fn has_line_of_sight(&self, from: usize, to: usize) -> bool {
        let ((x0, y0), (x1, y1)) = (self.column_and_row(from), self.column_and_row(to));
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
