//! Begins the map of a first run anew when a robot that was carried does not find its place in it.

use super::Brain;
use super::young_map::{MapWorth, YoungMapSearch};
use crate::localization::Localization;
use crate::model::decision::DecisionKind;
use crate::model::reason::Reason;

impl Brain {
    /// Follows the search for the robot's place for one step of so many seconds, and begins the map anew when the search has cost what
    /// the map is worth.
    pub(super) fn search_in_young_map(&mut self, time_s: f64) {
        if !self.localization.estimate().lost {
            self.young_map_search = YoungMapSearch::default();
            return;
        }
        if !self.may_begin_map_anew() {
            return;
        }
        let is_cleaning = self.behavior.cleans_whole_home();
        let map = &self.map;
        let worth = || MapWorth::of(map.free_m2(), Localization::may_relocalize_in(map));
        if self.young_map_search.is_over_after(time_s, is_cleaning, worth) {
            self.begin_map_anew();
        }
    }

    /// Whether nothing but this run has gone into the map: no earlier run, no person, no beacon whose place is kept.
    fn may_begin_map_anew(&self) -> bool {
        let is_first_run = self.map_agreement().is_some() && !self.map.knows_home();
        is_first_run
            && self.map.annotations().is_empty()
            && self.map.beacons().is_empty()
            && !self.map.dock_location().is_reported()
    }

    fn begin_map_anew(&mut self) {
        let searched_s = core::mem::take(&mut self.young_map_search).time_s();
        self.map.begin_anew();
        self.map.avoid(self.behavior.avoided());
        self.beams.forget();
        self.localization.begin_in_new_map(&self.config);
        self.behavior.begin_in_new_map();
        self.mind
            .decide(DecisionKind::BeginMapAnew, Reason::PlaceUnknown, searched_s);
    }
}
