//! Relocalizes a robot that turns out to be somewhere else.

use super::Localization;
use super::parameters::PLACING;
use crate::localization::drift::Drift;
use crate::localization::lift::Lift;
use crate::localization::reference_map::ReferenceMap;
use crate::localization::rssi_fingerprint::RssiFingerprints;
use crate::localization::tracker::Tracker;
use crate::mapping::Map;
use crate::model::config::BrainConfig;

impl Localization {
    /// A map without content begins where the robot is, in a frame of its own. What is known of the gyro holds.
    pub(crate) fn begin_in_new_map(&mut self, config: &BrainConfig) {
        self.drift = Drift::default();
        self.lift = Lift::default();
        self.fingerprints = RssiFingerprints::default();
        self.odometry.calibration.interrupt();
        self.start_line_slam(config);
    }

    /// Whether a robot can find its place in `map`. It visits all cells, so it is not for every step.
    pub(crate) fn may_relocalize_in(map: &Map) -> bool {
        ReferenceMap::is_trustworthy(map)
    }

    /// The robot is somewhere in this map.
    pub(super) fn lose_in_map(&mut self, reference_map: ReferenceMap, config: &BrainConfig, seed: u64) {
        let mut tracker = Tracker::new(config.body.radius_m, config.sensors, seed);
        tracker.lose(self.pose());
        self.compare_with(reference_map, tracker);
        self.drift.sigma_m = PLACING.sigma_max;
    }
}
