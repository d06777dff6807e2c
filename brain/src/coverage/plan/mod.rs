//! A path over known floor that sweeps most of it early and with few turns.
//!
//! Terms. *Configuration space*: cells that the robot's centre can take, and the floor that a swath sweeps from there.
//! *Lane*: a straight drive along a row or column of cells that is worth it for what it sweeps. *Link*: the path from the
//! end of one lane to the start of the next. *Round*: lanes that are driven in one tour; leftovers that cost much for what
//! they sweep come in later rounds.
//!
//! All work is bounded by counts of cells and lanes, never by a clock: equal input gives equal plans on every machine.

mod bit_grid;
mod contour;
mod free_strips;
mod lanes;
mod parameters;
mod settings;
mod sweep_pattern;
mod timing;
mod tour;

use crate::mapping::{CELL_M, Cell, Raster};
use crate::model::geometry::{Point2, Pose2};
use crate::model::gradual::{StepBudget, at_once};
use crate::model::room_settings::Pattern;
pub use crate::navigation::PathSegment;
use crate::navigation::configuration_space::ConfigurationSpace;
use crate::navigation::lane_frame::LaneFrame;
use crate::navigation::router::Router;
use crate::navigation::smoothing::{self, Polyline};
use contour::{RingFloor, RingStart, ring_path};
use lanes::Picker;
use parameters::LANES;
pub(crate) use settings::reach_cells;
pub use settings::{Departure, PlanSettings};
pub(crate) use sweep_pattern::SweepPattern;
use tour::Tour;

/// A path to drive.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoveragePlan {
    /// Corners of the path in the map frame.
    pub corners: Vec<Point2>,
    /// The path along them, with arcs where there is room.
    pub segments: Vec<PathSegment>,
    /// Number of lanes.
    pub lanes: usize,
    /// Floor that the swath can reach, in square metres.
    pub floor_m2: f64,
    /// Part of it that is not swept yet, in square metres.
    pub open_m2: f64,
    /// Part of it that stays unswept after the plan, in square metres.
    pub left_m2: f64,
    /// Expected time in seconds.
    pub time_s: f64,
}

impl CoveragePlan {
    /// Floor that is already swept, in square metres.
    #[must_use]
    pub fn passed_m2(&self) -> f64 {
        (self.floor_m2 - self.open_m2).max(0.0)
    }

    /// Share of the floor that is already swept, 0..=1.
    #[must_use]
    pub fn share_passed(&self) -> f64 {
        if self.floor_m2 > 0.0 {
            1.0 - self.open_m2 / self.floor_m2
        } else {
            1.0
        }
    }

    /// Transforms a plan from `frame` to the frame of the map.
    #[must_use]
    pub(crate) fn in_map(mut self, frame: &LaneFrame) -> Self {
        if *frame == LaneFrame::OF_MAP {
            return self;
        }
        for corner in &mut self.corners {
            *corner = frame.point_in_map(*corner);
        }
        for segment in &mut self.segments {
            segment.start = frame.in_map() * segment.start;
        }
        self
    }
}

/// Plans a path over `reachable` (cells that the robot's centre can take) that sweeps all floor for which `swept` is false,
/// starting at `start`. Without anything to sweep or any reachable cell the plan has no corners.
#[must_use]
pub fn plan_coverage(
    reachable: &Raster<bool>,
    swept: impl Fn(Cell) -> bool,
    start: Pose2,
    settings: &PlanSettings,
) -> CoveragePlan {
    let departure = Departure {
        start,
        settings: *settings,
    };
    plan_pattern(reachable, Pattern::Lines, swept, departure)
}

/// As [`plan_coverage`], with this pattern.
#[must_use]
pub fn plan_pattern(
    reachable: &Raster<bool>,
    pattern: Pattern,
    swept: impl Fn(Cell) -> bool,
    departure: Departure,
) -> CoveragePlan {
    let area = Area {
        pattern: |_| Some(SweepPattern::from(pattern)),
        is_swept: swept,
    };
    at_once(plan_area(
        reachable,
        area,
        departure,
        &mut StepBudget::unlimited(),
    ))
}

/// The floor to sweep.
#[derive(Clone, Copy)]
pub(crate) struct Area<Pattern, IsSwept> {
    /// The pattern of each cell; `None` = the cell is not to be swept.
    pub(crate) pattern: Pattern,
    /// Whether a cell is already swept.
    pub(crate) is_swept: IsSwept,
}

/// As [`plan_coverage`], but only floor that has a pattern is swept and counted. The path may lead over all reachable
/// cells. Floor with rings comes first.
pub(crate) async fn plan_area(
    reachable: &Raster<bool>,
    area: Area<impl Fn(Cell) -> Option<SweepPattern>, impl Fn(Cell) -> bool>,
    departure: Departure,
    budget: &mut StepBudget,
) -> CoveragePlan {
    let Departure { start, settings } = &departure;
    let mut space = ConfigurationSpace::new(reachable, reach_cells(settings), budget).await;
    let Some(origin) = space.origin_near(start.position(), budget).await else {
        return CoveragePlan::default();
    };
    space.keep_connected(origin, budget).await;
    space.close(|cell| (area.pattern)(cell).is_none(), budget).await;
    let floor = space.open_count();
    let ring_floor = RingFloor::of(&space, area.pattern, budget).await;
    space.close(area.is_swept, budget).await;
    let open = space.open_count();
    let ring_start = RingStart {
        departure: &departure,
        cell: origin,
    };
    let rings = match &ring_floor {
        Some(floor) => Some(ring_path(&space, floor, ring_start, budget).await),
        None => None,
    };
    let (mut corners, ring_sections, (from, heading_rad)) = match rings {
        Some(path) => {
            space.open = path.open;
            (path.corners, path.sections, path.end)
        }
        None => (Vec::new(), 0, (origin, start.heading_rad)),
    };
    let mut picker = Picker::new(&mut space, settings, budget).await;
    let rounds_max = if ring_floor.is_some() {
        LANES.rounds_beside_rings
    } else {
        LANES.round_shares.len()
    };
    let rounds = picker.rounds(rounds_max, budget).await;
    let router = Router::new(&space, budget).await;
    let start_of_lanes = Pose2 {
        heading_rad,
        ..*start
    };
    let mut tour = Tour::new(&router, settings, start_of_lanes, from);
    tour.drive(&rounds, budget).await;
    // The lanes begin where the rings end.
    corners.pop();
    let ring_corners = corners.len();
    corners.extend(tour.corners(budget).await);
    let polyline = Polyline {
        corners: &corners,
        ring_corners,
        heading_rad: start.heading_rad,
    };
    let segments = smoothing::segments(polyline, &space, budget).await;
    CoveragePlan {
        time_s: segments.iter().map(|segment| settings.time_s(segment)).sum(),
        corners,
        segments,
        lanes: ring_sections + rounds.iter().map(Vec::len).sum::<usize>(),
        floor_m2: floor as f64 * CELL_M * CELL_M,
        open_m2: open as f64 * CELL_M * CELL_M,
        left_m2: space.open_count() as f64 * CELL_M * CELL_M,
    }
}

/// All floor that a robot at `departure` can sweep, whether swept already or not.
pub(crate) async fn floor_in_reach(
    reachable: &Raster<bool>,
    departure: &Departure,
    budget: &mut StepBudget,
) -> Raster<bool> {
    let mut space = ConfigurationSpace::new(reachable, reach_cells(&departure.settings), budget).await;
    let mut floor = Raster::filled(space.cell(0), space.width, space.height, false);
    if let Some(origin) = space.origin_near(departure.start.position(), budget).await {
        space.keep_connected(origin, budget).await;
        floor.values_mut().copy_from_slice(&space.open);
    }
    floor
}

#[cfg(test)]
mod tests {
    use super::CoveragePlan;
    use crate::model::geometry::{Point2, Pose2};
    use crate::navigation::PathSegment;
    use crate::navigation::lane_frame::LaneFrame;

    #[test]
    fn a_plan_is_transformed_into_the_frame_of_the_map() {
        let frame = LaneFrame::along(0.6);
        let at = Point2 { x_m: 1.3, y_m: -4.2 };
        let pose = Pose2 {
            x_m: at.x_m,
            y_m: at.y_m,
            heading_rad: 3.0,
        };
        let segment = PathSegment {
            start: frame.pose(pose),
            length_m: 0.5,
            turn_rad: 0.2,
        };
        let plan = CoveragePlan {
            corners: vec![frame.point(at)],
            segments: vec![segment],
            ..CoveragePlan::default()
        };
        let there = plan.in_map(&frame);
        assert!(there.corners[0].distance_m(at) < 1e-12);
        let start = there.segments[0].start;
        assert!(start.position().distance_m(at) < 1e-12 && (start.heading_rad - 3.0).abs() < 1e-12);
        assert_eq!(
            (there.segments[0].length_m, there.segments[0].turn_rad),
            (0.5, 0.2)
        );
    }
}
