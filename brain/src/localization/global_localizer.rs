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

/// Parameters of global localization. They are chosen by hand in simulated homes; `docs/book/src/measurements/relocalization.md` shows what
/// they achieve together, and no record compares values of a single one.
struct SearchParameters {
    /// Poses that are tried in one step: a millisecond on a desktop core.
    positions_per_step: usize,
    /// Directions that are tried.
    directions: u32,
    /// Most points on obstacles.
    solid_max: usize,
    /// Most points where the body was.
    body_max: usize,
    /// Most points that beams saw to be free.
    open_max: usize,
    /// Fewest points on obstacles for a search.
    solid_min: usize,
    /// Tolerance of the coarse search.
    coarse: Tolerance,
    /// A coarse candidate must reach this share of the highest possible score.
    coarse_share_min: f64,
    /// It must also reach this share of the best score so far.
    coarse_of_best_min: f64,
    /// Coarse candidates that are refined.
    coarse_max: usize,
    /// Solid points by which a pose may fall behind the required score before it is rejected.
    slack: f64,
    /// Tolerance of the refinement.
    fine: Tolerance,
    /// Refined candidates must reach this share of the best score.
    fine_share_min: f64,
    /// Candidates that are returned.
    fine_max: usize,
    /// Poses closer than this are the same, metres.
    same_m: f64,
    /// Poses with a smaller difference in heading than this are the same, radians.
    same_rad: f64,
    /// Cost of a body inside a wall, in solid points.
    body_cost: f64,
    /// Cost of a free point inside a wall, in solid points.
    open_cost: f64,
}

const PARAMETERS: SearchParameters = SearchParameters {
    positions_per_step: 300,
    directions: 72,
    solid_max: 70,
    body_max: 60,
    open_max: 50,
    solid_min: 12,
    coarse: Tolerance {
        floor_m: 0.14,
        per_m: 0.05,
    },
    coarse_share_min: 0.45,
    coarse_of_best_min: 0.75,
    coarse_max: 48,
    slack: 4.0,
    fine: Tolerance {
        floor_m: 0.05,
        per_m: 0.02,
    },
    fine_share_min: 0.8,
    fine_max: 8,
    same_m: 0.4,
    same_rad: 0.35,
    body_cost: 2.0,
    open_cost: 0.7,
};

/// Tolerance of a point: a constant, and a share of its distance from the robot, because directions are coarse and odometry bends.
#[derive(Clone, Copy, Debug)]
struct Tolerance {
    floor_m: f64,
    per_m: f64,
}

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

/// The coarse search in one direction.
#[derive(Clone, Debug)]
struct CoarseSearch {
    /// Number of the direction.
    direction: u32,
    /// The coarse points, turned to this direction.
    turned: Vec<Probe>,
    /// The next position to try.
    position: usize,
}

/// The next work.
#[derive(Clone, Debug)]
enum SearchStage {
    /// Tries one direction.
    Coarse(CoarseSearch),
    /// Refines the candidates from this one on.
    Refine {
        next: usize,
    },
    Done,
}

impl GlobalLocalizer {
    /// For a robot of this radius; `None` when the history has too few points.
    pub(super) fn of(map: &impl Surroundings, history: &ScanHistory, radius_m: f64) -> Option<Self> {
        let coarse = probes(history, PARAMETERS.coarse);
        let solid = coarse
            .iter()
            .filter(|probe| probe.kind == PointKind::Solid)
            .count();
        (solid >= PARAMETERS.solid_min).then(|| Self {
            fine: probes(history, PARAMETERS.fine),
            solid,
            radius_m,
            positions: map.positions(),
            stage: coarse_stage(&coarse, 0),
            coarse,
            least: PARAMETERS.coarse_share_min * solid as f64,
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
            SearchStage::Coarse(search) => self.stage = self.try_positions(map, search),
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
    fn try_positions(&mut self, map: &impl Surroundings, search: CoarseSearch) -> SearchStage {
        let CoarseSearch {
            direction,
            turned,
            position,
        } = search;
        let solid = self.solid as f64;
        let tried = self
            .positions
            .iter()
            .skip(position)
            .take(PARAMETERS.positions_per_step);
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
            self.least = self.least.max(PARAMETERS.coarse_of_best_min * score * solid);
            self.found.push(PoseCandidate { pose, score });
        }
        let position = position + PARAMETERS.positions_per_step;
        if position < self.positions.len() {
            return SearchStage::Coarse(CoarseSearch {
                direction,
                turned,
                position,
            });
        }
        if direction + 1 < PARAMETERS.directions {
            return coarse_stage(&self.coarse, direction + 1);
        }
        best_first(&mut self.found);
        self.found = thinned(core::mem::take(&mut self.found));
        SearchStage::Refine { next: 0 }
    }
}

fn coarse_stage(coarse: &[Probe], direction: u32) -> SearchStage {
    SearchStage::Coarse(CoarseSearch {
        direction,
        turned: turned(coarse, direction_rad(direction)),
        position: 0,
    })
}

fn direction_rad(direction: u32) -> f64 {
    normalize_rad(core::f64::consts::TAU * f64::from(direction) / f64::from(PARAMETERS.directions))
}

fn probes(history: &ScanHistory, tolerance: Tolerance) -> Vec<Probe> {
    let mut probes = Vec::new();
    for (kind, most) in [
        (PointKind::Solid, PARAMETERS.solid_max),
        (PointKind::Body, PARAMETERS.body_max),
        (PointKind::Open, PARAMETERS.open_max),
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
        if kept.len() >= PARAMETERS.coarse_max {
            break;
        }
    }
    kept
}

fn is_same_place(one: Pose2, other: Pose2) -> bool {
    one.position().distance_m(other.position()) < PARAMETERS.same_m
        && normalize_rad(one.heading_rad - other.heading_rad).abs() < PARAMETERS.same_rad
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
    let mut allowed = PARAMETERS.slack;
    for probe in probes {
        let clear_m = map.clearance_m(Point2 {
            x_m: position.x_m + probe.at.x_m,
            y_m: position.y_m + probe.at.y_m,
        });
        score -= match probe.kind {
            PointKind::Solid => (clear_m.abs() / probe.tolerance_m).min(1.0),
            PointKind::Body => {
                PARAMETERS.body_cost * ((radius_m - clear_m) / probe.tolerance_m - 0.5).clamp(0.0, 1.0)
            }
            PointKind::Open => PARAMETERS.open_cost * (-clear_m / probe.tolerance_m).clamp(0.0, 1.0),
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
        if is_new
            && candidate.score >= PARAMETERS.fine_share_min * best.score
            && kept.len() < PARAMETERS.fine_max
        {
            kept.push(candidate);
        }
    }
    kept
}
