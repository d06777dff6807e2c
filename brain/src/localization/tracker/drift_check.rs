//! Before a robot is lost that nobody has carried away: do its last metres fit where it believes to be, or close by?
//!
//! A map that a robot has drawn lacks many a leg, and is bent by some centimetres. Among things that it lacks it explains as little
//! as in a wrong place, but the way there, of some metres, fits nowhere better.

use super::{SEARCH_FROM_M, SEARCHED, Tracker};
use crate::localization::candidates::{found_near, near_if_as_good};
use crate::localization::confidence::Confidence;
use crate::localization::particles::Surroundings;
use crate::model::geometry::Pose2;

/// Guesses that are this near to where the trail fits stay as they are, metres and radians.
const STAY_M: f64 = 0.15;
const STAY_RAD: f64 = 0.1;

impl Tracker {
    /// The map explains too little of what is seen at `pose`. The robot goes on while its last metres are laid over the map; then it is where
    /// they fit, if that is close by, or lost.
    pub(super) fn doubt(&mut self, map: &impl Surroundings, pose: Pose2) {
        let may_stay = !self.competes && self.unconfirmed == 0 && self.history.length_m() >= SEARCH_FROM_M;
        if self.global_localizer.is_none() && may_stay {
            self.global_localizer = self.second_look(map).map(Box::new);
        }
        let Some(search) = &self.global_localizer else {
            return self.lose_by_drift(pose);
        };
        let Some(places) = search.places() else { return };
        self.global_localizer = None;
        let Some(place) = found_near(&near_if_as_good(places, pose), pose) else {
            return self.lose_by_drift(pose);
        };
        let off = pose.inverse() * place;
        if off.position().distance_m(Pose2::IDENTITY.position()) > STAY_M || off.heading_rad.abs() > STAY_RAD
        {
            self.filter.scatter(&[place], SEARCHED);
        }
        self.confidence = Confidence::default();
    }

    /// Nobody has carried it away, but it is not where it believed to be.
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

    /// Drives for so many seconds; gives for how many steps the robot took itself for lost.
    fn drive(truth: &mut SimulatedRobot<'_>, localization: &mut Localization, seconds: u32) -> u32 {
        let mut lost = 0;
        for _ in 0..50 * seconds {
            let view = truth.step().clone();
            take(localization, &view);
            lost += u32::from(localization.estimate().lost);
        }
        lost
    }

    /// A robot that believes to be `off` the place where it is, and comes among things that its map lacks after a minute: how long
    /// it takes itself for lost in the half minute after, in steps, and how far off it is in the end.
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
    fn a_robot_that_is_right_is_not_lost_for_what_its_map_does_not_explain() {
        let (lost, off_m) = lost_and_off_m(Pose2::IDENTITY);
        assert_eq!(lost, 0);
        assert!(off_m < 0.06, "{off_m} m");
    }

    #[test]
    fn a_robot_that_is_elsewhere_takes_itself_for_lost() {
        let (lost, _) = lost_and_off_m(shifted(2.0, 1.4));
        assert!(lost > 0);
    }
}
