//! Relocalizes a robot that turns out to be somewhere else.

use super::Localization;
use super::parameters::PLACING;
use crate::localization::reference_map::ReferenceMap;
use crate::localization::tracker::Tracker;
use crate::mapping::Map;
use crate::model::config::BrainConfig;

impl Localization {
    /// The robot was put down somewhere.
    pub(super) fn relocalize(&mut self, map: &Map, config: &BrainConfig, seed: u64) {
        if ReferenceMap::is_trustworthy(map) {
            return self.lose_in_map(ReferenceMap::of(map), config, seed);
        }
        self.start_line_slam(config);
        self.drift.sigma_m = PLACING.sigma_max;
    }

    /// The robot is somewhere in this map.
    pub(super) fn lose_in_map(&mut self, reference_map: ReferenceMap, config: &BrainConfig, seed: u64) {
        let mut tracker = Tracker::new(config.body.radius_m, config.sensors, seed);
        tracker.lose(self.pose());
        self.compare_with(reference_map, tracker);
        self.drift.sigma_m = PLACING.sigma_max;
    }
}
