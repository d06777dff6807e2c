//! A way over known ground that sweeps most of it soon and with few turns.
//!
//! Terms. *Ground*: cells that the middle of the body can take, and the floor that a swath sweeps from there. *Lane*: a
//! straight piece along a row or column of cells that is worth driving for what it sweeps. *Link*: the way from the end of
//! one lane to the start of the next. *Round*: lanes that are driven in one tour; leftovers that cost much for what they
//! sweep come in later rounds.
//!
//! All work is bounded by counts of cells and lanes, never by a clock: equal ground gives equal plans on every machine.

mod bit_grid;
mod contour;
mod course;
mod lanes;
mod settings;
mod stretches;
mod timing;
mod tour;

use crate::mapping::{CELL_M, Cell, Raster};
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::{StepBudget, at_once};
use crate::model::room_settings::Pattern;
pub use crate::navigation::Piece;
use crate::navigation::configuration_space::Ground;
use crate::navigation::lane_frame::LaneFrame;
use crate::navigation::router::Router;
use crate::navigation::smoothing;
use contour::{RingFloor, ring_way};
pub(crate) use course::Course;
use lanes::Picker;
pub use settings::PlanSettings;
pub(crate) use settings::{Departure, reach_cells};
use tour::Tour;

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

    /// A plan that was made in `frame`, in the frame of the map.
    #[must_use]
    pub(crate) fn in_map(mut self, frame: &LaneFrame) -> Self {
        if *frame == LaneFrame::OF_MAP {
            return self;
        }
        for corner in &mut self.corners {
            *corner = frame.point_in_map(*corner);
        }
        for piece in &mut self.pieces {
            piece.start = frame.in_map() * piece.start;
        }
        self
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
    plan_pattern(reachable, (Pattern::Lines, swept), start, settings)
}

/// As [`plan_coverage`], with the floor swept by this pattern.
#[must_use]
pub fn plan_pattern(
    reachable: &Raster<bool>,
    (pattern, swept): (Pattern, impl Fn(Cell) -> bool),
    start: Pose2,
    settings: &PlanSettings,
) -> CoveragePlan {
    let from = Departure {
        start,
        settings: *settings,
    };
    let course = |_| Some(Course::from(pattern));
    at_once(plan_area(
        reachable,
        (course, swept),
        from,
        &mut StepBudget::unlimited(),
    ))
}

/// As [`plan_coverage`], but only floor that has a course is swept and counted; the way may lead over all that is reachable.
/// Floor with rings comes first.
pub(crate) async fn plan_area(
    reachable: &Raster<bool>,
    (course, swept): (impl Fn(Cell) -> Option<Course>, impl Fn(Cell) -> bool),
    departure: Departure,
    budget: &mut StepBudget,
) -> CoveragePlan {
    let Departure { start, settings } = &departure;
    let mut ground = Ground::new(reachable, reach_cells(settings), budget).await;
    let Some(origin) = ground.origin_near(start.position(), budget).await else {
        return CoveragePlan::default();
    };
    ground.keep_connected(origin, budget).await;
    ground.close(|cell| course(cell).is_none(), budget).await;
    let floor = ground.open_count();
    let ring_floor = RingFloor::of(&ground, course, budget).await;
    ground.close(swept, budget).await;
    let open = ground.open_count();
    let rings = match &ring_floor {
        Some(floor) => Some(ring_way(&ground, floor, (&departure, origin), budget).await),
        None => None,
    };
    let (mut corners, runs, (from, heading_rad)) = match rings {
        Some(way) => {
            ground.open = way.open;
            (way.corners, way.runs, way.end)
        }
        None => (Vec::new(), 0, (origin, start.heading_rad)),
    };
    let mut picker = Picker::new(&mut ground, settings, budget).await;
    let rounds = picker.rounds(budget).await;
    let router = Router::new(&ground, budget).await;
    let start_of_lanes = Pose2 {
        heading_rad,
        ..*start
    };
    let mut tour = Tour::new(&router, settings, start_of_lanes, from);
    tour.drive(&rounds, budget).await;
    // The lanes begin where the rings end.
    corners.pop();
    let of_rings = corners.len();
    corners.extend(tour.corners(budget).await);
    let pieces = smoothing::pieces((&corners, of_rings), start.heading_rad, (&ground, budget)).await;
    CoveragePlan {
        time_s: pieces.iter().map(|piece| settings.time_s(piece)).sum(),
        corners,
        pieces,
        lanes: runs + rounds.iter().map(Vec::len).sum::<usize>(),
        floor_m2: floor as f64 * CELL_M * CELL_M,
        open_m2: open as f64 * CELL_M * CELL_M,
        left_m2: ground.open_count() as f64 * CELL_M * CELL_M,
    }
}

/// All floor that a robot at `departure` can sweep, swept already or not.
pub(crate) async fn floor_in_reach(
    reachable: &Raster<bool>,
    departure: &Departure,
    budget: &mut StepBudget,
) -> Raster<bool> {
    let mut ground = Ground::new(reachable, reach_cells(&departure.settings), budget).await;
    let mut floor = Raster::filled(ground.cell(0), ground.width, ground.height, false);
    if let Some(origin) = ground.origin_near(departure.start.position(), budget).await {
        ground.keep_connected(origin, budget).await;
        floor.values_mut().copy_from_slice(&ground.open);
    }
    floor
}

#[cfg(test)]
mod tests {
    use super::CoveragePlan;
    use crate::model::geometry::{Point2, Pose2};
    use crate::navigation::Piece;
    use crate::navigation::lane_frame::LaneFrame;

    #[test]
    fn a_plan_is_turned_into_the_frame_of_the_map() {
        let frame = LaneFrame::along(0.6);
        let at = Point2 { x_m: 1.3, y_m: -4.2 };
        let pose = Pose2 {
            x_m: at.x_m,
            y_m: at.y_m,
            heading_rad: 3.0,
        };
        let piece = Piece {
            start: frame.pose(pose),
            length_m: 0.5,
            turn_rad: 0.2,
        };
        let plan = CoveragePlan {
            corners: vec![frame.point(at)],
            pieces: vec![piece],
            ..CoveragePlan::default()
        };
        let there = plan.in_map(&frame);
        assert!(there.corners[0].distance_m(at) < 1e-12);
        let start = there.pieces[0].start;
        assert!(start.position().distance_m(at) < 1e-12 && (start.heading_rad - 3.0).abs() < 1e-12);
        assert_eq!((there.pieces[0].length_m, there.pieces[0].turn_rad), (0.5, 0.2));
    }
}
