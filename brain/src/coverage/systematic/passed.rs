//! The floor that the swath has passed in this job, as the planner counts it: a disc around the robot's centre.
//!
//! The coverage grid of the map holds the bar under the robot, which is what people see. A plan based on that would send
//! the robot back to each end of a lane, for the half swath before the wall that the side brushes have reached.

use super::recent_track::{RecentTrack, TrackPoint};
use crate::mapping::{Cell, Map, Raster};
use crate::model::geometry::Point2;
use crate::navigation::{Disc, Situation};

/// Points of the path that are recalled in one step.
const RECALLED_A_STEP: usize = 1_000;

/// Passed cells.
#[derive(Debug)]
pub(super) struct Passed {
    /// Cells passed before the recent track.
    settled: Raster<bool>,
    track: RecentTrack,
    disc: Disc,
    /// Points of the job's path that were recalled, and their total.
    recalled: usize,
    to_recall: usize,
}

impl Passed {
    /// Records what this job passes from now on, with `reach` cells on either side of the centre. What it has passed so far
    /// is recalled from the map: a job that continues after a restart has no other memory.
    pub(super) fn new(map: &Map, window: &CellWindow, reach: usize) -> Self {
        Self {
            settled: Raster::filled(window.origin, window.width, window.height, false),
            track: RecentTrack::default(),
            disc: Disc::of_radius(reach as f64 + 0.6),
            recalled: 0,
            to_recall: map.snapshot().path.len(),
        }
    }

    /// Recalls some more of what this job has passed and swept. `true` when all of it is recalled.
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

    /// Forgets all passed cells.
    pub(super) fn forget(&mut self) {
        self.settled.values_mut().fill(false);
        self.track.forget();
    }

    /// Changes to another window; cells outside of it are forgotten.
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

    /// Counts floor as swept that the robot would have swept from a point beside its actual path. A strip that it left out
    /// because it kept away from an obstacle is not worth another drive.
    pub(super) fn skip_beside(&mut self, beside: Point2) {
        self.track.skip_beside(beside);
    }
}

impl Disc {
    /// Paints what is swept from a track point, and what was given up beside it.
    fn paint_point(&self, cells: &mut Raster<bool>, point: &TrackPoint) {
        for at in point.swept_from() {
            self.paint(cells, at);
        }
    }

    fn paint(&self, cells: &mut Raster<bool>, at: Point2) {
        let cell = Cell::under(at);
        let column = i64::from(cell.x) - i64::from(cells.origin().x);
        let row = i64::from(cell.y) - i64::from(cells.origin().y);
        self.set(cells, column, row);
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
    /// The window of a raster.
    fn of<T>(raster: &Raster<T>) -> Self {
        Self {
            origin: raster.origin(),
            width: raster.width(),
            height: raster.height(),
        }
    }

    /// The window of a raster with `margin` cells more on each side.
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
