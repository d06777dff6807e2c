//! Compares the signals that a lost robot has received lately with the fingerprints.

use super::parameters::MATCH;
use std::sync::Arc;

use super::map::FingerprintMap;
use super::mean_rssi::MeanRssi;
use crate::model::geometry::{Point2, Pose2};

/// Signal strengths around a robot, in its own frame, and the fingerprints of the home.
#[derive(Clone, Debug)]
pub(in super::super) struct FingerprintMatcher {
    around: Vec<(Point2, MeanRssi)>,
    map: Arc<FingerprintMap>,
}

impl FingerprintMatcher {
    pub(in super::super) fn new(around: Vec<(Point2, MeanRssi)>, map: Arc<FingerprintMap>) -> Self {
        Self { around, map }
    }

    /// Cost of a pose that does not explain the strengths; 0 where nothing is known.
    pub(in super::super) fn cost(&self, pose: Pose2) -> f64 {
        let (mut squares, mut compared) = (0.0, 0_usize);
        for (place, level) in &self.around {
            let expected_dbm = self.map.expected_dbm(level.beacon, pose.transform(*place));
            // Unknown positions count like a usual fit, so that no pose gains by being unknown.
            squares += expected_dbm.map_or(1.0, |expected_dbm| {
                compared += 1;
                let off = ((level.dbm - expected_dbm) / MATCH.sigma_db).clamp(-MATCH.off_max, MATCH.off_max);
                off * off
            });
        }
        if compared < MATCH.compared_min {
            return 0.0;
        }
        MATCH.cost * (squares / self.around.len() as f64 - 1.0).max(0.0)
    }
}
