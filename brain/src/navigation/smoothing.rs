//! Smooths a polyline into a path that the robot drives without stopping: arcs at corners where there is room, turns on the
//! spot elsewhere.

use super::configuration_space::ConfigurationSpace;
use super::heading::heading_rad;
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::gradual::StepBudget;
use crate::navigation::parameters::SMOOTHING;

/// Work of a corner.
const CORNER_WORK: usize = 300;

/// A segment of a path: an arc; without a turn a straight line; without a length a turn on the spot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSegment {
    /// Pose at its start.
    pub start: Pose2,
    /// Length in metres.
    pub length_m: f64,
    /// Turn along it in radians, counter-clockwise positive.
    pub turn_rad: f64,
}

impl PathSegment {
    /// The pose after a share of it, 0..=1.
    #[must_use]
    pub fn at(&self, share: f64) -> Pose2 {
        self.start.after_arc(share * self.length_m, share * self.turn_rad)
    }
}

/// A path without arcs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Polyline<'a> {
    pub(crate) corners: &'a [Point2],
    /// The first corners that belong to rings.
    pub(crate) ring_corners: usize,
    /// Heading of the robot at the first corner, radians.
    pub(crate) heading_rad: f64,
}

/// The smoothed path along a polyline.
pub(crate) async fn segments(
    polyline: Polyline<'_>,
    space: &ConfigurationSpace,
    budget: &mut StepBudget,
) -> Vec<PathSegment> {
    let corners = polyline.corners;
    let mut builder = SegmentBuilder {
        segments: Vec::with_capacity(2 * corners.len()),
        pose: Pose2 {
            heading_rad: polyline.heading_rad,
            ..corners.first().map_or(Pose2::IDENTITY, |corner| Pose2 {
                x_m: corner.x_m,
                y_m: corner.y_m,
                heading_rad: 0.0,
            })
        },
    };
    for (position, pair) in corners.windows(2).enumerate() {
        let (from, to) = (pair[0], pair[1]);
        builder.turn_to(heading_rad(from, to));
        let most_m = if position < polyline.ring_corners {
            SMOOTHING.ring_cut_max_m
        } else {
            SMOOTHING.cut_max_m
        };
        let cut_m = corners
            .get(position + 2)
            .map_or(0.0, |after| cut_m([from, to, *after], space, most_m));
        let ahead_m = builder.pose.position().distance_m(to) - cut_m;
        builder.add(ahead_m.max(0.0), 0.0);
        if let Some(after) = corners.get(position + 2)
            && cut_m > 0.0
        {
            let turn_rad = normalize_rad(heading_rad(to, *after) - builder.pose.heading_rad);
            let radius_m = cut_m / libm::tan(0.5 * turn_rad.abs());
            builder.add(radius_m * turn_rad.abs(), turn_rad);
        }
        budget.spend(CORNER_WORK).await;
    }
    builder.segments
}

struct SegmentBuilder {
    segments: Vec<PathSegment>,
    pose: Pose2,
}

impl SegmentBuilder {
    fn turn_to(&mut self, heading_rad: f64) {
        let turn_rad = normalize_rad(heading_rad - self.pose.heading_rad);
        if turn_rad.abs() > SMOOTHING.slight_turn_rad {
            self.add(0.0, turn_rad);
        }
        self.pose.heading_rad = heading_rad;
    }

    fn add(&mut self, length_m: f64, turn_rad: f64) {
        if length_m <= 0.0 && turn_rad == 0.0 {
            return;
        }
        let segment = PathSegment {
            start: self.pose,
            length_m,
            turn_rad,
        };
        self.pose = segment.at(1.0);
        self.segments.push(segment);
    }
}

/// How much of the straights before and after a corner an arc may replace, up to `most_m`; 0 = turn on the spot.
fn cut_m([before, corner, after]: [Point2; 3], space: &ConfigurationSpace, most_m: f64) -> f64 {
    let turn_rad = normalize_rad(heading_rad(corner, after) - heading_rad(before, corner)).abs();
    if !SMOOTHING.arc_turn_rad.contains(&turn_rad) {
        return 0.0;
    }
    let (behind_m, ahead_m) = (before.distance_m(corner), corner.distance_m(after));
    // Half of each straight, so that the corners at its two ends do not overlap.
    let mut cut_m = most_m.min(0.5 * behind_m).min(0.5 * ahead_m);
    let least_m = SMOOTHING
        .cut_min_m
        .max(SMOOTHING.radius_min_m * libm::tan(0.5 * turn_rad));
    while cut_m >= least_m {
        let start = between(corner, before, cut_m / behind_m);
        let end = between(corner, after, cut_m / ahead_m);
        if space.has_line_of_sight_between(start, end) {
            return cut_m;
        }
        cut_m *= 0.5;
    }
    0.0
}

fn between(from: Point2, to: Point2, share: f64) -> Point2 {
    Point2 {
        x_m: from.x_m + share * (to.x_m - from.x_m),
        y_m: from.y_m + share * (to.y_m - from.y_m),
    }
}
