//! Decides from the candidate poses of a global localization, the best one first.

use super::global_localizer::PoseCandidate;
use crate::model::geometry::Pose2;

/// When a candidate pose of global localization is accepted.
struct CandidateParameters {
    /// Least score of a result.
    score_min: f64,
    /// The result is ambiguous when another candidate has at least this share of the best score.
    ambiguous_share: f64,
    /// A cluster of particles is at a candidate within this distance, metres.
    cluster_max_m: f64,
    /// Greatest drift before the map explains too little, metres.
    drift_max_m: f64,
}

const PARAMETERS: CandidateParameters = CandidateParameters {
    score_min: 0.45,
    ambiguous_share: 0.93,
    cluster_max_m: 0.4,
    drift_max_m: 0.5,
};

/// Whether `pose` is at the best candidate, and no other one scores nearly as high.
pub(super) fn is_alone(candidates: &[PoseCandidate], pose: Pose2) -> bool {
    is_far_ahead(candidates, pose, PARAMETERS.ambiguous_share)
}

/// Whether `pose` is at the best candidate, and all others score less than a share of it.
pub(super) fn is_far_ahead(candidates: &[PoseCandidate], pose: Pose2, share: f64) -> bool {
    let Some((best, others)) = candidates.split_first() else {
        return false;
    };
    best.score >= PARAMETERS.score_min
        && is_at(best, pose)
        && others
            .iter()
            .all(|other| is_at(other, pose) || other.score < share * best.score)
}

/// Whether `pose` is at any candidate.
pub(super) fn is_among(candidates: &[PoseCandidate], pose: Pose2) -> bool {
    candidates.iter().any(|place| is_at(place, pose))
}

/// For a robot that nobody has carried away: only the candidates near its odometry, if one of them scores nearly as high as the
/// best. Rooms look alike, and the robot is more likely to be in the one where it was.
pub(super) fn near_if_as_good(candidates: Vec<PoseCandidate>, carried: Pose2) -> Vec<PoseCandidate> {
    let least = PARAMETERS.ambiguous_share * candidates.first().map_or(0.0, |best| best.score);
    let is_near = |place: &PoseCandidate| is_within_drift(place, carried);
    if candidates
        .iter()
        .any(|place| is_near(place) && place.score >= least)
    {
        candidates.into_iter().filter(is_near).collect()
    } else {
        candidates
    }
}

/// The best candidate, if a robot at `pose` can have drifted there and the score suffices.
pub(super) fn found_near(candidates: &[PoseCandidate], pose: Pose2) -> Option<Pose2> {
    let best = candidates
        .first()
        .filter(|best| best.score >= PARAMETERS.score_min)?;
    is_within_drift(best, pose).then_some(best.pose)
}

fn is_within_drift(place: &PoseCandidate, pose: Pose2) -> bool {
    place.pose.position().distance_m(pose.position()) <= PARAMETERS.drift_max_m
}

fn is_at(place: &PoseCandidate, pose: Pose2) -> bool {
    place.pose.position().distance_m(pose.position()) <= PARAMETERS.cluster_max_m
}

#[cfg(test)]
mod tests {
    use super::{PoseCandidate, found_near, is_alone, near_if_as_good};
    use crate::model::geometry::Pose2;

    fn place(x_m: f64, score: f64) -> PoseCandidate {
        PoseCandidate { pose: at(x_m), score }
    }

    fn at(x_m: f64) -> Pose2 {
        Pose2 {
            x_m,
            ..Pose2::IDENTITY
        }
    }

    #[test]
    fn among_equal_rooms_a_drifted_robot_stays_in_its_room() {
        let candidates = vec![place(7.0, 0.8), place(0.3, 0.78), place(-4.0, 0.3)];
        assert!(!is_alone(&candidates, at(0.3)), "it may be at either");
        let near = near_if_as_good(candidates, at(0.0));
        assert!(is_alone(&near, at(0.3)));
    }

    #[test]
    fn a_better_candidate_far_away_is_kept() {
        let candidates = vec![place(7.0, 0.8), place(0.3, 0.6)];
        assert_eq!(near_if_as_good(candidates.clone(), at(0.0)), candidates);
        assert_eq!(near_if_as_good(vec![], at(0.0)), []);
        assert_eq!(found_near(&candidates, at(0.0)), None);
        assert_eq!(found_near(&candidates, at(6.5)), Some(at(7.0)));
    }
}
