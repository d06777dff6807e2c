//! Which floor the swath has passed in this job, as the planner sees it: a disc around the middle.
//!
//! The swept layer of the map paints the bar under the robot, which is what people are shown. A plan made from that would
//! send the robot back to each end of a lane for the half swath before the wall that the side brushes have reached.

use super::reachable::Disc;
use crate::geometry::Point2;
use crate::mapping::{CELL_M, Cell, Map, Raster};

/// Way after which the disc is painted again.
const STEP_M: f64 = 0.5 * CELL_M;

/// Passed cells.
#[derive(Debug)]
pub(super) struct Passed {
    cells: Raster<bool>,
    disc: Disc,
    last: Option<Point2>,
}

impl Passed {
    /// Nothing passed, in the window of `like`. `reach` cells to either side of the middle count.
    fn new(like: &Raster<bool>, reach: usize) -> Self {
        Self {
            cells: Raster::filled(like.origin(), like.width(), like.height(), false),
            disc: Disc::of_radius(reach as f64 + 0.6),
            last: None,
        }
    }

    /// What the way of this job has passed so far, where it cleaned: the map remembers it, and a job that goes on after a
    /// restart has no other memory.
    pub(super) fn along(map: &Map, like: &Raster<bool>, reach: usize) -> Self {
        let mut passed = Self::new(like, reach);
        for point in map.snapshot().path {
            let at = Point2 {
                x_m: 0.001 * f64::from(point.x_mm),
                y_m: 0.001 * f64::from(point.y_mm),
            };
            if map.is_swept(at) {
                passed.follow(at);
            }
        }
        passed.last = None;
        passed
    }

    /// Nothing was passed.
    pub(super) fn forget(&mut self) {
        self.cells.values_mut().fill(false);
    }

    /// Takes over another window; what lies outside of it is forgotten.
    pub(super) fn cover(&mut self, like: &Raster<bool>) {
        if (like.origin(), like.width(), like.height())
            == (self.cells.origin(), self.cells.width(), self.cells.height())
        {
            return;
        }
        let mut cells = Raster::filled(like.origin(), like.width(), like.height(), false);
        for index in 0..cells.values().len() {
            let passed = self.contains(cells.cell(index));
            if let Some(cell) = cells.values_mut().get_mut(index) {
                *cell = passed;
            }
        }
        self.cells = cells;
    }

    pub(super) fn follow(&mut self, place: Point2) {
        if self.last.is_some_and(|last| last.distance_m(place) < STEP_M) {
            return;
        }
        self.last = Some(place);
        self.paint(place);
    }

    /// Counts what would have been swept from a place beside the way that the robot really takes: a strip that it left out
    /// because it came too near to something is not worth another way.
    pub(super) fn give_up(&mut self, place: Point2) {
        self.paint(place);
    }

    fn paint(&mut self, place: Point2) {
        let cell = Cell::under(place);
        let column = i64::from(cell.x) - i64::from(self.cells.origin().x);
        let row = i64::from(cell.y) - i64::from(self.cells.origin().y);
        self.disc.fill(&mut self.cells, (column, row), true);
    }

    pub(super) fn contains(&self, cell: Cell) -> bool {
        self.cells.get(cell).copied().unwrap_or(false)
    }
}
