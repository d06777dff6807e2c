//! Decides from the candidate poses of a global localization, the best one first.

use super::global_localizer::PoseCandidate;
use crate::model::geometry::Pose2;

/// The result is ambiguous when another candidate has at least this share of the best score.
const RIVAL_SHARE: f64 = 0.93;
/// Least score of a result.
const FIND_SCORE: f64 = 0.45;
/// A cluster of particles is at a candidate within this distance, metres.
const AT_PLACE_M: f64 = 0.4;
/// Greatest drift before the map explains too little, metres.
const DRIFT_M: f64 = 0.5;

/// Whether `pose` is at the best candidate, and no other one scores nearly as high.
pub(super) fn is_alone(places: &[PoseCandidate], pose: Pose2) -> bool {
    let Some((best, others)) = places.split_first() else {
        return false;
    };
    best.score >= FIND_SCORE
        && is_at(best, pose)
        && others
            .iter()
            .all(|other| is_at(other, pose) || other.score < RIVAL_SHARE * best.score)
}

/// Whether `pose` is at any candidate.
pub(super) fn is_among(places: &[PoseCandidate], pose: Pose2) -> bool {
    places.iter().any(|place| is_at(place, pose))
}

/// For a robot that nobody has carried away: only the candidates near its odometry, if one of them scores nearly as high as the
/// best. Rooms look alike, and the robot is more likely to be in the one where it was.
pub(super) fn near_if_as_good(places: Vec<PoseCandidate>, carried: Pose2) -> Vec<PoseCandidate> {
    let least = RIVAL_SHARE * places.first().map_or(0.0, |best| best.score);
    let is_near = |place: &PoseCandidate| is_within_drift(place, carried);
    if places.iter().any(|place| is_near(place) && place.score >= least) {
        places.into_iter().filter(is_near).collect()
    } else {
        places
    }
}

/// The best candidate, if a robot at `pose` can have drifted there and the score suffices.
pub(super) fn found_near(places: &[PoseCandidate], pose: Pose2) -> Option<Pose2> {
    let best = places.first().filter(|best| best.score >= FIND_SCORE)?;
    is_within_drift(best, pose).then_some(best.pose)
}

fn is_within_drift(place: &PoseCandidate, pose: Pose2) -> bool {
    place.pose.position().distance_m(pose.position()) <= DRIFT_M
}

fn is_at(place: &PoseCandidate, pose: Pose2) -> bool {
    place.pose.position().distance_m(pose.position()) <= AT_PLACE_M
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
    fn of_rooms_that_look_alike_a_robot_that_drifted_is_in_the_one_that_it_believed_in() {
        let places = vec![place(7.0, 0.8), place(0.3, 0.78), place(-4.0, 0.3)];
        assert!(!is_alone(&places, at(0.3)), "it may be at either");
        let near = near_if_as_good(places, at(0.0));
        assert!(is_alone(&near, at(0.3)));
    }

    #[test]
    fn a_place_far_away_that_fits_better_is_not_passed_over() {
        let places = vec![place(7.0, 0.8), place(0.3, 0.6)];
        assert_eq!(near_if_as_good(places.clone(), at(0.0)), places);
        assert_eq!(near_if_as_good(vec![], at(0.0)), []);
        assert_eq!(found_near(&places, at(0.0)), None);
        assert_eq!(found_near(&places, at(6.5)), Some(at(7.0)));
    }
}
