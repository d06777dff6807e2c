//! Compares the signals that a lost robot has received lately with the fingerprints.

use std::sync::Arc;

use super::map::FingerprintMap;
use super::mean_rssi::MeanRssi;
use crate::model::geometry::{Point2, Pose2};

/// Standard deviation between a mean and the fingerprint of the same position, decibels: remaining fading, direction of the
/// antenna, interpolation.
const SIGMA_DB: f64 = 3.5;
/// Greatest deviation that counts: somebody may be in the path.
const OFF_MAX: f64 = 3.0;
/// Cost of a pose, in the score of global localization, for each unit by which the mean square of the deviations exceeds 1.
const COST: f64 = 0.08;
/// Fewest comparisons for a cost.
const COMPARED_MIN: usize = 4;

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
                let off = ((level.dbm - expected_dbm) / SIGMA_DB).clamp(-OFF_MAX, OFF_MAX);
                off * off
            });
        }
        if compared < COMPARED_MIN {
            return 0.0;
        }
        COST * (squares / self.around.len() as f64 - 1.0).max(0.0)
    }
}
