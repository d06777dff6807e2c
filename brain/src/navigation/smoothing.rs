//! From corners to a way that a robot drives without stopping: arcs at corners where there is room, turns on the spot
//! where there is none.

use super::configuration_space::Ground;
use super::heading::heading_rad;
use crate::model::geometry::{Point2, Pose2, normalize_rad};
use crate::model::gradual::StepBudget;

/// Longest part of a straight that an arc takes at a corner.
const CUT_MAX_M: f64 = 0.15;
/// The same at the corners of rings: the next ring does not sweep what an arc cuts off.
const RING_CUT_MAX_M: f64 = 0.08;
/// An arc that takes less than this is no better than a turn on the spot.
const CUT_MIN_M: f64 = 0.02;
/// A tighter one takes as long as a turn on the spot, and a robot that enters it a little early is beside it at once, metres.
const RADIUS_MIN_M: f64 = 0.05;
/// Sharper corners are turned on the spot.
const SHARP_RAD: f64 = 2.5;
/// Turns below this are left to steering.
const SLIGHT_RAD: f64 = 0.01;
/// Work of a corner.
const CORNER_WORK: usize = 300;

/// A part of a way: an arc, with no turn a straight line, with no length a turn on the spot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Where it starts, and in which direction.
    pub start: Pose2,
    /// Length in metres.
    pub length_m: f64,
    /// Turn along it in radians, counter-clockwise positive.
    pub turn_rad: f64,
}

impl Piece {
    /// The pose after a share of it, 0..=1.
    #[must_use]
    pub fn at(&self, share: f64) -> Pose2 {
        self.start.after_arc(share * self.length_m, share * self.turn_rad)
    }
}

/// The way along `corners`, of which so many of the first are those of rings, from the heading that the robot has at the
/// first one.
pub(crate) async fn pieces(
    (corners, of_rings): (&[Point2], usize),
    heading_now_rad: f64,
    (ground, budget): (&Ground, &mut StepBudget),
) -> Vec<Piece> {
    let mut maker = Maker {
        pieces: Vec::with_capacity(2 * corners.len()),
        pose: Pose2 {
            heading_rad: heading_now_rad,
            ..corners.first().map_or(Pose2::IDENTITY, |corner| Pose2 {
                x_m: corner.x_m,
                y_m: corner.y_m,
                heading_rad: 0.0,
            })
        },
    };
    for (position, pair) in corners.windows(2).enumerate() {
        let (from, to) = (pair[0], pair[1]);
        maker.turn_to(heading_rad(from, to));
        let most_m = if position < of_rings {
            RING_CUT_MAX_M
        } else {
            CUT_MAX_M
        };
        let cut_m = corners
            .get(position + 2)
            .map_or(0.0, |after| cut_m([from, to, *after], (ground, most_m)));
        let ahead_m = maker.pose.position().distance_m(to) - cut_m;
        maker.add(ahead_m.max(0.0), 0.0);
        if let Some(after) = corners.get(position + 2)
            && cut_m > 0.0
        {
            let turn_rad = normalize_rad(heading_rad(to, *after) - maker.pose.heading_rad);
            let radius_m = cut_m / libm::tan(0.5 * turn_rad.abs());
            maker.add(radius_m * turn_rad.abs(), turn_rad);
        }
        budget.spend(CORNER_WORK).await;
    }
    maker.pieces
}

struct Maker {
    pieces: Vec<Piece>,
    pose: Pose2,
}

impl Maker {
    fn turn_to(&mut self, heading_rad: f64) {
        let turn_rad = normalize_rad(heading_rad - self.pose.heading_rad);
        if turn_rad.abs() > SLIGHT_RAD {
            self.add(0.0, turn_rad);
        }
        self.pose.heading_rad = heading_rad;
    }

    fn add(&mut self, length_m: f64, turn_rad: f64) {
        if length_m <= 0.0 && turn_rad == 0.0 {
            return;
        }
        let piece = Piece {
            start: self.pose,
            length_m,
            turn_rad,
        };
        self.pose = piece.at(1.0);
        self.pieces.push(piece);
    }
}

/// How much of the straights before and after a corner an arc may take, up to `most_m`; 0 = turn on the spot.
fn cut_m([before, corner, after]: [Point2; 3], (ground, most_m): (&Ground, f64)) -> f64 {
    let turn_rad = normalize_rad(heading_rad(corner, after) - heading_rad(before, corner)).abs();
    if !(0.1..SHARP_RAD).contains(&turn_rad) {
        return 0.0;
    }
    let (behind_m, ahead_m) = (before.distance_m(corner), corner.distance_m(after));
    // Half of each straight, so that the corners at its two ends do not need the same part of it.
    let mut cut_m = most_m.min(0.5 * behind_m).min(0.5 * ahead_m);
    let least_m = CUT_MIN_M.max(RADIUS_MIN_M * libm::tan(0.5 * turn_rad));
    while cut_m >= least_m {
        let start = between(corner, before, cut_m / behind_m);
        let end = between(corner, after, cut_m / ahead_m);
        if ground.sees_points(start, end) {
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
