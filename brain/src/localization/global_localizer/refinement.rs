//! From coarse poses to the few that are worth a closer look.

use super::PoseCandidate;
use super::probe::Probes;
use crate::localization::particles::Surroundings;
use crate::model::geometry::{Pose2, normalize_rad};

/// Coarse candidates that are refined.
const COARSE_MAX: usize = 48;
/// Coarse candidates of one place.
const OF_PLACE_MAX: usize = 3;
/// Refined candidates must reach this share of the best score.
const FINE_SHARE_MIN: f64 = 0.8;
/// Candidates that are returned.
const FINE_MAX: usize = 8;
/// Poses closer than this are the same, metres.
const SAME_M: f64 = 0.4;
/// Poses with a smaller difference in heading than this are the same, radians.
const SAME_RAD: f64 = 0.35;
/// Steps of hill climbing, metres and radians.
const STEPS: [(f64, f64); 3] = [(0.06, 0.03), (0.03, 0.015), (0.015, 0.007)];
/// Rounds with a step.
const ROUNDS: usize = 8;

/// The best candidates, at most a few of each place.
pub(super) fn thinned(mut found: Vec<PoseCandidate>) -> Vec<PoseCandidate> {
    best_first(&mut found);
    let mut kept: Vec<PoseCandidate> = Vec::new();
    for candidate in found {
        let neighbours = kept
            .iter()
            .filter(|other| is_same_place(other.pose, candidate.pose))
            .count();
        if neighbours < OF_PLACE_MAX {
            kept.push(candidate);
        }
        if kept.len() >= COARSE_MAX {
            break;
        }
    }
    kept
}

/// One candidate of each place, if its score is close to the best.
pub(super) fn distinct(mut found: Vec<PoseCandidate>) -> Vec<PoseCandidate> {
    best_first(&mut found);
    let Some(best) = found.first().copied() else {
        return found;
    };
    let mut kept: Vec<PoseCandidate> = Vec::new();
    for candidate in found {
        let is_new = !kept.iter().any(|other| is_same_place(other.pose, candidate.pose));
        if is_new && candidate.score >= FINE_SHARE_MIN * best.score && kept.len() < FINE_MAX {
            kept.push(candidate);
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

/// Refines a candidate by hill climbing with ever smaller steps.
pub(super) fn refined(map: &impl Surroundings, probes: &Probes, start: Pose2) -> PoseCandidate {
    let rate = |pose: Pose2| {
        let points = probes.score(map, pose, f64::NEG_INFINITY);
        points.map_or(f64::NEG_INFINITY, |points| points / probes.solid())
    };
    let mut best = PoseCandidate {
        pose: start,
        score: rate(start),
    };
    for (step_m, step_rad) in STEPS {
        for _ in 0..ROUNDS {
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
