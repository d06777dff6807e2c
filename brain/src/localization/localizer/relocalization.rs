//! A robot that turns out to be somewhere else in its home looks for itself in the map.

use super::{Localization, SIGMA_MAX};
use crate::localization::terrain::Terrain;
use crate::localization::tracker::Tracker;
use crate::mapping::Map;
use crate::model::config::BrainConfig;

impl Localization {
    /// The robot was put down somewhere.
    pub(super) fn recover(&mut self, map: &Map, config: &BrainConfig, seed: u64) {
        if Terrain::is_trustworthy(map) {
            return self.lose_in(Terrain::of(map), config, seed);
        }
        self.survey(config);
        self.drift.sigma_m = SIGMA_MAX;
    }

    /// The robot is somewhere in this terrain.
    pub(super) fn lose_in(&mut self, terrain: Terrain, config: &BrainConfig, seed: u64) {
        let mut tracker = Tracker::new(config.body.radius_m, config.sensors, seed);
        tracker.lose(self.pose());
        self.compare_with(terrain, tracker);
        self.drift.sigma_m = SIGMA_MAX;
    }
}
