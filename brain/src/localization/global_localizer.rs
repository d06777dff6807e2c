//! Global localization: finds all poses in the map that match the last metres. It tries every position in every direction, and
//! refines the best poses.
//!
//! A coarse grid of poses is tried with wide tolerances, and most poses are rejected after a few points. That costs some hundred
//! milliseconds for a home, in many steps, and needs no randomness.

use super::particles::Surroundings;
use super::rssi_fingerprint::FingerprintMatcher;
use super::scan_history::{PointKind, ScanHistory};
use crate::model::advance::Advance;
use crate::model::geometry::{Point2, Pose2, normalize_rad};

/// Poses that are tried in one step: a millisecond on a desktop core.
const POSITIONS_PER_STEP: usize = 300;
/// Directions that are tried.
const DIRECTIONS: u32 = 72;
/// Most points of each kind.
const SOLID_MAX: usize = 70;
const BODY_MAX: usize = 60;
const OPEN_MAX: usize = 50;
/// Fewest solid points.
const SOLID_MIN: usize = 12;
/// A coarse candidate must reach this share of the highest possible score,
const COARSE_SHARE: f64 = 0.45;
/// and this share of the best score so far.
const COARSE_OF_BEST: f64 = 0.75;
/// Coarse candidates that are refined.
const COARSE_MAX: usize = 48;
/// Candidates that are returned.
const FINE_MAX: usize = 8;
/// They must reach this share of the best score.
const FINE_SHARE: f64 = 0.8;
/// Poses closer than this are the same, metres and radians.
const SAME_M: f64 = 0.4;
const SAME_RAD: f64 = 0.35;
/// Costs of a body inside a wall and of a free point inside a wall, in solid points.
const BODY_COST: f64 = 2.0;
const OPEN_COST: f64 = 0.7;

/// Solid points by which a pose may fall behind the required score before it is rejected.
const SLACK: f64 = 4.0;

/// Tolerance of a point: a constant, and a share of its distance from the robot, because directions are coarse and odometry bends.
#[derive(Clone, Copy, Debug)]
struct Tolerance {
    floor_m: f64,
    per_m: f64,
}

const COARSE: Tolerance = Tolerance {
    floor_m: 0.14,
    per_m: 0.05,
};
const FINE: Tolerance = Tolerance {
    floor_m: 0.05,
    per_m: 0.02,
};

/// A point of the history relative to the robot.
#[derive(Clone, Copy, Debug)]
struct Probe {
    at: Point2,
    kind: PointKind,
    tolerance_m: f64,
}

/// A pose that matches the history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PoseCandidate {
    pub(super) pose: Pose2,
    /// Share of the solid points that match, less the contradictions, at most 1.
    pub(super) score: f64,
}

/// A search in progress. The robot drives on meanwhile.
#[derive(Clone, Debug)]
pub(super) struct GlobalLocalizer {
    coarse: Vec<Probe>,
    fine: Vec<Probe>,
    /// Number of solid points.
    solid: usize,
    radius_m: f64,
    positions: Vec<Point2>,
    stage: SearchStage,
    /// Least score of a coarse candidate, in solid points.
    least: f64,
    found: Vec<PoseCandidate>,
    /// Signal strengths along the history.
    rssi: Option<FingerprintMatcher>,
    /// Motion since the search began.
    moved: Pose2,
}

/// The next work.
#[derive(Clone, Debug)]
enum SearchStage {
    /// Tries this direction at the positions from this one on.
    Coarse {
        direction: u32,
        turned: Vec<Probe>,
        position: usize,
    },
    /// Refines the candidates from this one on.
    Refine {
        next: usize,
    },
    Done,
}

impl GlobalLocalizer {
    /// For a robot of this radius; `None` when the history has too few points.
    pub(super) fn of(map: &impl Surroundings, history: &ScanHistory, radius_m: f64) -> Option<Self> {
        let coarse = probes(history, COARSE);
        let solid = coarse
            .iter()
            .filter(|probe| probe.kind == PointKind::Solid)
            .count();
        (solid >= SOLID_MIN).then(|| Self {
            fine: probes(history, FINE),
            solid,
            radius_m,
            positions: map.positions(),
            stage: coarse_stage(&coarse, 0),
            coarse,
            least: COARSE_SHARE * solid as f64,
            found: Vec::new(),
            rssi: None,
            moved: Pose2::IDENTITY,
        })
    }

    /// The same search with signal strengths.
    pub(super) fn with_rssi(self, rssi: Option<FingerprintMatcher>) -> Self {
        Self { rssi, ..self }
    }

    /// Cost of a pose that does not explain the signal strengths.
    fn cost(&self, pose: Pose2) -> f64 {
        self.rssi.as_ref().map_or(0.0, |rssi| rssi.cost(pose))
    }

    fn scoring(&self, least: f64) -> Scoring {
        Scoring {
            radius_m: self.radius_m,
            solid: self.solid as f64,
            least,
        }
    }

    /// The robot has moved on.
    pub(super) fn follow(&mut self, advance: Advance) {
        self.moved = self.moved.after_arc(advance.distance_m, advance.turn_rad);
    }

    /// Does a step.
    pub(super) fn go_on(&mut self, map: &impl Surroundings) {
        match core::mem::replace(&mut self.stage, SearchStage::Done) {
            SearchStage::Coarse {
                direction,
                turned,
                position,
            } => self.stage = self.try_positions(map, direction, (turned, position)),
            SearchStage::Refine { next } => {
                if let Some(start) = self.found.get(next).map(|candidate| candidate.pose) {
                    let scoring = self.scoring(f64::NEG_INFINITY);
                    let mut best = refined(map, &self.fine, scoring, start);
                    best.score -= self.cost(best.pose);
                    if let Some(candidate) = self.found.get_mut(next) {
                        *candidate = best;
                    }
                    self.stage = SearchStage::Refine { next: next + 1 };
                } else {
                    self.found = distinct(core::mem::take(&mut self.found));
                }
            }
            SearchStage::Done => {}
        }
    }

    /// All candidate poses of the robot now, the best one first; `None` while the search goes on.
    pub(super) fn candidates(&self) -> Option<Vec<PoseCandidate>> {
        let moved = |candidate: &PoseCandidate| PoseCandidate {
            pose: candidate.pose * self.moved,
            ..*candidate
        };
        matches!(self.stage, SearchStage::Done).then(|| self.found.iter().map(moved).collect())
    }

    /// Tries some more positions, and returns the next stage.
    fn try_positions(
        &mut self,
        map: &impl Surroundings,
        direction: u32,
        (turned, position): (Vec<Probe>, usize),
    ) -> SearchStage {
        let solid = self.solid as f64;
        let tried = self.positions.iter().skip(position).take(POSITIONS_PER_STEP);
        for position in tried {
            let scoring = self.scoring(self.least);
            let Some(score) = score(map, &turned, *position, scoring) else {
                continue;
            };
            let pose = Pose2 {
                x_m: position.x_m,
                y_m: position.y_m,
                heading_rad: direction_rad(direction),
            };
            let score = score - self.cost(pose);
            if score * solid < self.least {
                continue;
            }
            self.least = self.least.max(COARSE_OF_BEST * score * solid);
            self.found.push(PoseCandidate { pose, score });
        }
        let position = position + POSITIONS_PER_STEP;
        if position < self.positions.len() {
            return SearchStage::Coarse {
                direction,
                turned,
                position,
            };
        }
        if direction + 1 < DIRECTIONS {
            return coarse_stage(&self.coarse, direction + 1);
        }
        best_first(&mut self.found);
        self.found = thinned(core::mem::take(&mut self.found));
        SearchStage::Refine { next: 0 }
    }
}

fn coarse_stage(coarse: &[Probe], direction: u32) -> SearchStage {
    SearchStage::Coarse {
        direction,
        turned: turned(coarse, direction_rad(direction)),
        position: 0,
    }
}

fn direction_rad(direction: u32) -> f64 {
    normalize_rad(core::f64::consts::TAU * f64::from(direction) / f64::from(DIRECTIONS))
}

fn probes(history: &ScanHistory, tolerance: Tolerance) -> Vec<Probe> {
    let mut probes = Vec::new();
    for (kind, most) in [
        (PointKind::Solid, SOLID_MAX),
        (PointKind::Body, BODY_MAX),
        (PointKind::Open, OPEN_MAX),
    ] {
        probes.extend(history.points(kind, most).into_iter().map(|at| Probe {
            at,
            kind,
            tolerance_m: tolerance.floor_m + tolerance.per_m * at.distance_m(Point2::ORIGIN),
        }));
    }
    shuffled(&probes)
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

/// The best candidates, at most a few of each place.
fn thinned(found: Vec<PoseCandidate>) -> Vec<PoseCandidate> {
    let mut kept: Vec<PoseCandidate> = Vec::new();
    for candidate in found {
        let neighbours = kept
            .iter()
            .filter(|other| is_same_place(other.pose, candidate.pose))
            .count();
        if neighbours < 3 {
            kept.push(candidate);
        }
        if kept.len() >= COARSE_MAX {
            break;
        }
    }
    kept
}

fn is_same_place(one: Pose2, other: Pose2) -> bool {
    one.position().distance_m(other.position()) < SAME_M
        && normalize_rad(one.heading_rad - other.heading_rad).abs() < SAME_RAD
}

fn best_first(candidates: &mut [PoseCandidate]) {
    candidates.sort_by(|one, other| other.score.total_cmp(&one.score));
}

fn turned(probes: &[Probe], heading_rad: f64) -> Vec<Probe> {
    let turn = Pose2 {
        heading_rad,
        ..Pose2::IDENTITY
    };
    probes
        .iter()
        .map(|probe| Probe {
            at: turn.transform(probe.at),
            ..*probe
        })
        .collect()
}

/// What a score depends on besides points and position.
#[derive(Clone, Copy, Debug)]
struct Scoring {
    radius_m: f64,
    /// Number of solid points.
    solid: f64,
    /// Least score, in solid points.
    least: f64,
}

/// Score of rotated points at a position; `None` when it does not reach `least`, or falls too far behind it before the last point.
fn score(map: &impl Surroundings, probes: &[Probe], position: Point2, scoring: Scoring) -> Option<f64> {
    let Scoring {
        radius_m,
        solid,
        least,
    } = scoring;
    let mut score = solid;
    let per_probe = (solid - least) / probes.len().max(1) as f64;
    let mut allowed = SLACK;
    for probe in probes {
        let clear_m = map.clearance_m(Point2 {
            x_m: position.x_m + probe.at.x_m,
            y_m: position.y_m + probe.at.y_m,
        });
        score -= match probe.kind {
            PointKind::Solid => (clear_m.abs() / probe.tolerance_m).min(1.0),
            PointKind::Body => BODY_COST * ((radius_m - clear_m) / probe.tolerance_m - 0.5).clamp(0.0, 1.0),
            PointKind::Open => OPEN_COST * (-clear_m / probe.tolerance_m).clamp(0.0, 1.0),
        };
        allowed += per_probe;
        if score + allowed < solid {
            return None;
        }
    }
    if score < least {
        return None;
    }
    Some(score / solid)
}

/// Refines a candidate by hill climbing with ever smaller steps.
fn refined(map: &impl Surroundings, probes: &[Probe], scoring: Scoring, start: Pose2) -> PoseCandidate {
    let rate = |pose: Pose2| {
        score(map, &turned(probes, pose.heading_rad), pose.position(), scoring).unwrap_or(f64::NEG_INFINITY)
    };
    let mut best = PoseCandidate {
        pose: start,
        score: rate(start),
    };
    for (step_m, step_rad) in [(0.06, 0.03), (0.03, 0.015), (0.015, 0.007)] {
        for _ in 0..8 {
            let before = best.score;
            for (x, y, heading) in [
                (1.0, 0.0, 0.0),
                (-1.0, 0.0, 0.0),
                (0.0, 1.0, 0.0),
                (0.0, -1.0, 0.0),
                (0.0, 0.0, 1.0),
                (0.0, 0.0, -1.0),
            ] {
                let pose = Pose2 {
                    x_m: best.pose.x_m + x * step_m,
                    y_m: best.pose.y_m + y * step_m,
                    heading_rad: normalize_rad(best.pose.heading_rad + heading * step_rad),
                };
                let score = rate(pose);
                if score > best.score {
                    best = PoseCandidate { pose, score };
                }
            }
            if best.score <= before {
                break;
            }
        }
    }
    best
}

/// One candidate of each place, if its score is close to the best.
fn distinct(mut found: Vec<PoseCandidate>) -> Vec<PoseCandidate> {
    best_first(&mut found);
    let Some(best) = found.first().copied() else {
        return found;
    };
    let mut kept: Vec<PoseCandidate> = Vec::new();
    for candidate in found {
        let is_new = !kept.iter().any(|other| is_same_place(other.pose, candidate.pose));
        if is_new && candidate.score >= FINE_SHARE * best.score && kept.len() < FINE_MAX {
            kept.push(candidate);
        }
    }
    kept
}
