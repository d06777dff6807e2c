//! Before a robot is lost that nobody has carried away: do its last metres fit where it believes to be, or close by?
//!
//! A map that a robot has drawn lacks many a leg, and is bent by some centimetres. Among things that it lacks it explains as little
//! as in a wrong place, but the way there, of some metres, fits nowhere better.

use super::{SEARCH_FROM_M, SEARCHED, Tracker, Whole};
use crate::geometry::Pose2;
use crate::localization::confidence::Confidence;
use crate::localization::particles::Surroundings;
use crate::localization::places::{found_near, near_if_as_good};
use crate::localization::search::Search;

/// Guesses that are this near to where the trail fits stay as they are, metres and radians.
const STAY_M: f64 = 0.15;
const STAY_RAD: f64 = 0.1;

impl Tracker {
    /// The map explains too little of what is seen at `pose`. The robot goes on while its last metres are laid over the map; then it is where
    /// they fit, if that is close by, or lost.
    pub(super) fn doubt(&mut self, map: &impl Surroundings, pose: Pose2) {
        let may_stay = !self.is_rival && self.probation == 0 && self.trail.length_m() >= SEARCH_FROM_M;
        if self.searching.is_none() && may_stay {
            self.searching = Search::of(&Whole(map), &self.trail, self.radius_m).map(Box::new);
        }
        let Some(search) = &self.searching else {
            return self.lose_by_drift(pose);
        };
        let Some(places) = search.places() else { return };
        self.searching = None;
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
