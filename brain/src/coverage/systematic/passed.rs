//! Which floor the swath has passed in this job, as the planner sees it: a disc around the middle.
//!
//! The swept layer of the map paints the bar under the robot, which is what people are shown. A plan made from that would
//! send the robot back to each end of a lane for the half swath before the wall that the side brushes have reached.

use super::recent_track::{RecentTrack, TrackPoint};
use crate::mapping::{Cell, Map, Raster};
use crate::model::geometry::Point2;
use crate::navigation::{Disc, Situation};

/// Places of the way that are recalled in one step.
const RECALLED_A_STEP: usize = 1_000;

/// Passed cells.
#[derive(Debug)]
pub(super) struct Passed {
    /// What was passed before the trail.
    settled: Raster<bool>,
    track: RecentTrack,
    disc: Disc,
    /// Places of the job's way that were recalled, of those that are to be.
    recalled: usize,
    to_recall: usize,
}

impl Passed {
    /// What the way of this job passes from now on. `reach` cells to either side of the middle count. What it has passed so
    /// far is still to be recalled: the map remembers it, and a job that goes on after a restart has no other memory.
    pub(super) fn new(map: &Map, window: &CellWindow, reach: usize) -> Self {
        Self {
            settled: Raster::filled(window.origin, window.width, window.height, false),
            track: RecentTrack::default(),
            disc: Disc::of_radius(reach as f64 + 0.6),
            recalled: 0,
            to_recall: map.snapshot().path.len(),
        }
    }

    /// Recalls some more of what the way of this job had passed where it cleaned. `true` when all of it is there.
    pub(super) fn recall(&mut self, map: &Map) -> bool {
        let path = map.snapshot().path;
        let end = self.to_recall.min(path.len());
        let some = (self.recalled + RECALLED_A_STEP).min(end);
        for point in path.get(self.recalled..some).unwrap_or_default() {
            let at = Point2 {
                x_m: 0.001 * f64::from(point.x_mm),
                y_m: 0.001 * f64::from(point.y_mm),
            };
            if map.is_swept(at) {
                self.disc.paint(&mut self.settled, at);
            }
        }
        self.recalled = some;
        some == end
    }

    /// Nothing was passed.
    pub(super) fn forget(&mut self) {
        self.settled.values_mut().fill(false);
        self.track.forget();
    }

    /// Takes over another window; what lies outside of it is forgotten.
    pub(super) fn cover(&mut self, window: &CellWindow) {
        if *window == CellWindow::of(&self.settled) {
            return;
        }
        let mut cells = Raster::filled(window.origin, window.width, window.height, false);
        cells.copy_from(&self.settled);
        self.settled = cells;
    }

    /// The cells as they are known now.
    pub(super) fn cells(&self) -> Raster<bool> {
        let mut cells = self.settled.clone();
        for point in self.track.points() {
            self.disc.paint_point(&mut cells, point);
        }
        cells
    }

    pub(super) fn follow(&mut self, situation: &Situation<'_>) {
        let advance = situation.is_tracked.then_some(situation.advance);
        for point in self.track.follow(&situation.estimate, advance) {
            self.disc.paint_point(&mut self.settled, &point);
        }
    }

    /// Counts what would have been swept from a place beside the way that the robot really takes: a strip that it left out
    /// because it came too near to something is not worth another way.
    pub(super) fn give_up(&mut self, beside: Point2) {
        self.track.give_up(beside);
    }
}

impl Disc {
    /// Paints what is swept from a place of the way, and what was given up beside it.
    fn paint_point(&self, cells: &mut Raster<bool>, point: &TrackPoint) {
        for at in point.swept_from() {
            self.paint(cells, at);
        }
    }

    fn paint(&self, cells: &mut Raster<bool>, at: Point2) {
        let cell = Cell::under(at);
        let column = i64::from(cell.x) - i64::from(cells.origin().x);
        let row = i64::from(cell.y) - i64::from(cells.origin().y);
        self.fill(cells, (column, row), true);
    }
}

/// A rectangle of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CellWindow {
    origin: Cell,
    width: usize,
    height: usize,
}

impl CellWindow {
    /// That of a raster.
    fn of<T>(raster: &Raster<T>) -> Self {
        Self {
            origin: raster.origin(),
            width: raster.width(),
            height: raster.height(),
        }
    }

    /// That of a raster with `margin` cells more on each side.
    pub(super) fn around<T>(raster: &Raster<T>, margin: usize) -> Self {
        let shift = i32::try_from(margin).unwrap_or(0);
        Self {
            origin: Cell {
                x: raster.origin().x.saturating_sub(shift),
                y: raster.origin().y.saturating_sub(shift),
            },
            width: raster.width() + 2 * margin,
            height: raster.height() + 2 * margin,
        }
    }
}
