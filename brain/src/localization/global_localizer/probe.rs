//! Points of the last metres, and how well they fit a map from a pose.

use crate::localization::floor_blocks::FloorBlock;
use crate::localization::particles::Surroundings;
use crate::localization::scan_history::{PointKind, ScanHistory};
use crate::model::geometry::{Point2, Pose2};

/// Most points on obstacles.
const SOLID_MAX: usize = 70;
/// Most points where the body was.
const BODY_MAX: usize = 60;
/// Most points that beams saw to be free.
const OPEN_MAX: usize = 50;
/// Solid points by which a pose may fall behind the required score before it is rejected.
const SLACK: f64 = 4.0;
/// Cost of a body inside a wall, in solid points.
const BODY_COST: f64 = 2.0;
/// Cost of a free point inside a wall, in solid points.
const OPEN_COST: f64 = 0.7;

/// Tolerance of a point: a constant, and a share of its distance from the robot, because directions are coarse and odometry bends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    pub(super) floor_m: f64,
    pub(super) per_m: f64,
}

/// A point of the history relative to the robot.
#[derive(Clone, Copy, Debug)]
struct Probe {
    at: Point2,
    kind: PointKind,
    tolerance_m: f64,
}

/// The points of the last metres.
#[derive(Clone, Debug)]
pub(super) struct Probes {
    all: Vec<Probe>,
    /// Number of solid points: the highest score.
    solid: f64,
    /// Radius of the body.
    radius_m: f64,
}

impl Probes {
    pub(super) fn of(history: &ScanHistory, tolerance: Tolerance, radius_m: f64) -> Self {
        let mut all = Vec::new();
        for (kind, most) in [
            (PointKind::Solid, SOLID_MAX),
            (PointKind::Body, BODY_MAX),
            (PointKind::Open, OPEN_MAX),
        ] {
            all.extend(history.points(kind, most).into_iter().map(|at| Probe {
                at,
                kind,
                tolerance_m: tolerance.floor_m + tolerance.per_m * at.distance_m(Point2::ORIGIN),
            }));
        }
        let solid = all.iter().filter(|probe| probe.kind == PointKind::Solid).count();
        Self {
            all: shuffled(&all),
            solid: solid as f64,
            radius_m,
        }
    }

    pub(super) const fn solid(&self) -> f64 {
        self.solid
    }

    /// Points that match at a pose, less the contradictions; `None` when they do not reach `least`, or fall too far behind it before
    /// the last point.
    pub(super) fn score(&self, map: &impl Surroundings, pose: Pose2, least: f64) -> Option<f64> {
        self.added_up(pose, least, |at| {
            let clear_m = map.clearance_m(at);
            Clearance {
                nearest_m: clear_m.abs(),
                greatest_m: clear_m,
            }
        })
    }

    /// What [`Self::score`] is at most at the positions of a block; `None` when it is `None` at all of them.
    pub(super) fn score_at_most(
        &self,
        map: &impl Surroundings,
        (block, heading_rad): (&FloorBlock, f64),
        least: f64,
    ) -> Option<f64> {
        let middle = Pose2 {
            x_m: block.middle.x_m,
            y_m: block.middle.y_m,
            heading_rad,
        };
        self.added_up(middle, least, |at| {
            let (least_m, greatest_m) = map.clearance_around_m(at, block.radius_m);
            Clearance {
                nearest_m: least_m.max(-greatest_m).max(0.0),
                greatest_m,
            }
        })
    }

    /// Adds up what the points cost from a pose, with a clearance at each.
    fn added_up(&self, pose: Pose2, least: f64, clearance: impl Fn(Point2) -> Clearance) -> Option<f64> {
        let (sin, cos) = libm::sincos(pose.heading_rad);
        let mut score = self.solid;
        let per_probe = (self.solid - least) / self.all.len().max(1) as f64;
        let mut allowed = SLACK;
        for probe in &self.all {
            let clear = clearance(Point2 {
                x_m: pose.x_m + cos * probe.at.x_m - sin * probe.at.y_m,
                y_m: pose.y_m + sin * probe.at.x_m + cos * probe.at.y_m,
            });
            score -= self.cost(probe, clear);
            allowed += per_probe;
            if score + allowed < self.solid {
                return None;
            }
        }
        (score >= least).then_some(score)
    }

    fn cost(&self, probe: &Probe, clear: Clearance) -> f64 {
        match probe.kind {
            PointKind::Solid => (clear.nearest_m / probe.tolerance_m).min(1.0),
            PointKind::Body => {
                let inside_m = self.radius_m - clear.greatest_m;
                BODY_COST * (inside_m / probe.tolerance_m - 0.5).clamp(0.0, 1.0)
            }
            PointKind::Open => OPEN_COST * (-clear.greatest_m / probe.tolerance_m).clamp(0.0, 1.0),
        }
    }
}

/// Clearance of the places where a point can be.
#[derive(Clone, Copy, Debug)]
struct Clearance {
    /// Distance to the nearest border of an obstacle, from whichever place is nearest to one, metres.
    nearest_m: f64,
    /// Distance from the nearest obstacle at the freest place, metres; negative inside of one.
    greatest_m: f64,
}

/// A fixed order in which neighbours are far apart, so that the first few points represent the whole history.
fn shuffled(probes: &[Probe]) -> Vec<Probe> {
    let count = probes.len().max(1);
    // Close to the golden ratio and coprime to the count, so it visits all.
    let mut stride = (count as f64 * 0.618) as usize;
    while stride > 1 && greatest_divisor(stride, count) != 1 {
        stride -= 1;
    }
    (0..probes.len())
        .filter_map(|step| probes.get(step * stride.max(1) % count))
        .copied()
        .collect()
}

fn greatest_divisor(mut one: usize, mut other: usize) -> usize {
    while other != 0 {
        (one, other) = (other, one % other);
    }
    one
}

#[cfg(test)]
impl Probes {
    /// What a robot at a pose could know of its surroundings.
    pub(super) fn around(
        map: &impl Surroundings,
        pose: Pose2,
        random: &mut crate::model::random::Random,
    ) -> Self {
        const NEAR_M: f64 = 2.0;
        let mut all = Vec::new();
        let mut solid = 0.0;
        while solid < 30.0 {
            let at = Point2 {
                x_m: random.between(-NEAR_M, NEAR_M),
                y_m: random.between(-NEAR_M, NEAR_M),
            };
            let clear_m = map.clearance_m(pose.transform(at));
            let kind = if clear_m.abs() < 0.02 {
                solid += 1.0;
                PointKind::Solid
            } else if clear_m > 0.2 && all.len() % 9 == 0 {
                PointKind::Body
            } else if clear_m > 0.02 && all.len() % 9 == 4 {
                PointKind::Open
            } else {
                continue;
            };
            let tolerance_m = 0.14 + 0.05 * at.distance_m(Point2::ORIGIN);
            all.push(Probe {
                at,
                kind,
                tolerance_m,
            });
        }
        Self {
            all,
            solid,
            radius_m: 0.175,
        }
    }
}
