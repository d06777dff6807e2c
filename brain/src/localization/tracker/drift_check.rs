//! Checks a doubtful pose before the robot counts as lost: do the last metres match the map at the estimate, or close by?
//!
//! A map that a robot has drawn lacks many legs and is distorted by some centimetres. Among obstacles that it lacks it explains as
//! little as at a wrong pose, but the last metres match nowhere better.

use super::Tracker;
use super::parameters::{SEARCH, TRACKING};
use crate::localization::candidates::{found_near, near_if_as_good};
use crate::localization::confidence::Confidence;
use crate::localization::particles::Surroundings;
use crate::model::geometry::Pose2;

/// Particles this close to the matching pose stay as they are, metres and radians.
const STAY_M: f64 = 0.15;
const STAY_RAD: f64 = 0.1;

impl Tracker {
    /// The map explains too little at `pose`. The robot drives on while its last metres are matched against the map. Then it is at
    /// the match, if that is close, or lost.
    pub(super) fn doubt(&mut self, map: &impl Surroundings, pose: Pose2) {
        let may_stay = !self.competes && self.unconfirmed == 0 && self.history.length_m() >= SEARCH.from_m;
        if self.global_localizer.is_none() && may_stay {
            self.global_localizer = self.second_look(map).map(Box::new);
        }
        let Some(search) = &self.global_localizer else {
            return self.lose_by_drift(pose);
        };
        let Some(candidates) = search.candidates() else {
            return;
        };
        self.global_localizer = None;
        let Some(match_pose) = found_near(&near_if_as_good(candidates, pose), pose) else {
            return self.lose_by_drift(pose);
        };
        let off = pose.inverse() * match_pose;
        if off.position().distance_m(Pose2::IDENTITY.position()) > STAY_M || off.heading_rad.abs() > STAY_RAD
        {
            self.filter.scatter(&[match_pose], TRACKING.candidate);
        }
        self.confidence = Confidence::default();
    }

    /// Nobody has carried the robot away, but it is not at its estimate.
    pub(super) fn lose_by_drift(&mut self, pose: Pose2) {
        self.lose(pose);
        self.has_drifted = true;
    }
}

#[cfg(test)]
mod tests {
    use crate::localization::Localization;
    use crate::localization::known_home::{START, SimulatedRobot, flat, placed, take};
    use crate::localization::particles::BeamScore;
    use crate::model::geometry::Pose2;

    /// Drives for so many seconds. Returns for how many steps the robot was lost.
    fn drive(truth: &mut SimulatedRobot<'_>, localization: &mut Localization, seconds: u32) -> u32 {
        let mut lost = 0;
        for _ in 0..50 * seconds {
            let view = truth.step().clone();
            take(localization, &view);
            lost += u32::from(localization.estimate().lost);
        }
        lost
    }

    /// A robot whose estimate is off by `off` comes among obstacles that its map lacks after a minute. Returns the number of lost
    /// steps in the next half minute, and the final error.
    fn lost_and_off_m(off: Pose2) -> (u32, f64) {
        let map = flat();
        let mut truth = SimulatedRobot::new(&map, START);
        let mut localization = placed(&map, off * START);
        drive(&mut truth, &mut localization, 60);
        let tracker = &mut localization
            .estimator
            .known_map_mut()
            .expect("a map to compare with")
            .tracker;
        let unexplained = BeamScore {
            informative: 200,
            consistent: 0,
        };
        tracker.confidence.take(unexplained);
        let lost = drive(&mut truth, &mut localization, 30);
        (lost, truth.off_m(&localization))
    }

    fn shifted(x_m: f64, y_m: f64) -> Pose2 {
        Pose2 {
            x_m,
            y_m,
            heading_rad: 0.0,
        }
    }

    #[test]
    fn a_robot_with_a_right_pose_is_not_lost_among_unmapped_obstacles() {
        let (lost, off_m) = lost_and_off_m(Pose2::IDENTITY);
        assert_eq!(lost, 0);
        assert!(off_m < 0.06, "{off_m} m");
    }

    #[test]
    fn a_robot_with_a_wrong_pose_is_lost() {
        let (lost, _) = lost_and_off_m(shifted(2.0, 1.4));
        assert!(lost > 0);
    }
}
