//! A way over known ground that sweeps most of it soon and with few turns.
//!
//! Terms. *Ground*: cells that the middle of the body can take, and the floor that a swath sweeps from there. *Lane*: a
//! straight piece along a row or column of cells that is worth driving for what it sweeps. *Link*: the way from the end of
//! one lane to the start of the next. *Round*: lanes that are driven in one tour; leftovers that cost much for what they
//! sweep come in later rounds.
//!
//! All work is bounded by counts of cells and lanes, never by a clock: equal ground gives equal plans on every machine.

mod bits;
mod ground;
mod heading;
mod lanes;
mod queue;
mod route;
mod smooth;
mod stretches;
mod tour;
mod way;

use crate::geometry::{Point2, Pose2};
use crate::gradual::{Pace, at_once};
use crate::mapping::{CELL_M, Cell, Raster};
use ground::Ground;
use lanes::Picker;
use route::Router;
pub use smooth::Piece;
use tour::Tour;
pub(crate) use way::{Goal, plan_way};

/// What a plan depends on besides the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanSettings {
    /// Width that one pass cleans, in metres.
    pub swath_m: f64,
    /// Standard deviation of the pose estimate in metres: lanes overlap by twice as much.
    pub sigma_m: f64,
    /// Speed on lanes and links, m/s.
    pub cruise_m_per_s: f64,
    /// Turn rate, rad/s.
    pub turn_rad_per_s: f64,
}

/// A way to drive.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoveragePlan {
    /// Corners of the way in the map frame.
    pub corners: Vec<Point2>,
    /// The way along them, with arcs where there is room.
    pub pieces: Vec<Piece>,
    /// Lanes in it.
    pub lanes: usize,
    /// Floor that the ground offers to the swath, in square metres.
    pub floor_m2: f64,
    /// What of it is not swept yet, in square metres.
    pub open_m2: f64,
    /// What of it will not be swept after the plan either, in square metres.
    pub left_m2: f64,
    /// Expected time in seconds.
    pub time_s: f64,
}

impl CoveragePlan {
    /// Floor that is swept already, in square metres.
    #[must_use]
    pub fn passed_m2(&self) -> f64 {
        (self.floor_m2 - self.open_m2).max(0.0)
    }

    /// Share of the floor that is swept already, 0..=1.
    #[must_use]
    pub fn share_passed(&self) -> f64 {
        if self.floor_m2 > 0.0 {
            1.0 - self.open_m2 / self.floor_m2
        } else {
            1.0
        }
    }
}

/// Plans a way over `reachable` (cells that the middle of the body can take) that sweeps what `swept` has not seen yet,
/// starting at `start`. Without anything to sweep or any reachable cell the plan has no corners.
#[must_use]
pub fn plan_coverage(
    reachable: &Raster<bool>,
    swept: impl Fn(Cell) -> bool,
    start: Pose2,
    settings: &PlanSettings,
) -> CoveragePlan {
    let from = Departure {
        start,
        settings: *settings,
    };
    at_once(plan_area(
        reachable,
        (|_| true, swept),
        from,
        &mut Pace::at_once(),
    ))
}

/// Where a plan begins, and what it depends on besides the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Departure {
    pub(crate) start: Pose2,
    pub(crate) settings: PlanSettings,
}

/// As [`plan_coverage`], but only `wanted` floor is swept and counted; the way may lead over all that is reachable.
pub(crate) async fn plan_area(
    reachable: &Raster<bool>,
    (wanted, swept): (impl Fn(Cell) -> bool, impl Fn(Cell) -> bool),
    Departure { start, settings }: Departure,
    pace: &mut Pace,
) -> CoveragePlan {
    let settings = &settings;
    let mut ground = Ground::new(reachable, reach_cells(settings), pace).await;
    let Some(origin) = ground.origin_near(start.position(), pace).await else {
        return CoveragePlan::default();
    };
    ground.keep_connected(origin, pace).await;
    ground.close(|cell| !wanted(cell), pace).await;
    let floor = ground.open_count();
    ground.close(swept, pace).await;
    let open = ground.open_count();
    let mut picker = Picker::new(&mut ground, settings, pace).await;
    let rounds = picker.rounds(pace).await;
    let router = Router::new(&ground, pace).await;
    let mut tour = Tour::new(&router, settings, start, origin);
    for lanes in &rounds {
        tour.extend(lanes, pace).await;
    }
    let corners = tour.corners(pace).await;
    let pieces = smooth::pieces(&corners, start.heading_rad, (&ground, pace)).await;
    CoveragePlan {
        time_s: pieces.iter().map(|piece| piece.time_s(settings)).sum(),
        corners,
        pieces,
        lanes: rounds.iter().map(Vec::len).sum(),
        floor_m2: floor as f64 * CELL_M * CELL_M,
        open_m2: open as f64 * CELL_M * CELL_M,
        left_m2: ground.open_count() as f64 * CELL_M * CELL_M,
    }
}

/// Cells to either side of a lane's own that it counts as swept.
pub(crate) fn reach_cells(settings: &PlanSettings) -> usize {
    let half_m = 0.5 * settings.swath_m - settings.sigma_m;
    (libm::floor(half_m / CELL_M - 0.25).clamp(1.0, 40.0)) as usize
}
