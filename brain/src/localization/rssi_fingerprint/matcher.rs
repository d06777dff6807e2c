//! What a lost robot has received on its last metres, laid over what is received where.

use std::sync::Arc;

use super::map::FingerprintMap;
use super::mean_rssi::MeanRssi;
use crate::model::geometry::{Point2, Pose2};

/// Deviation of a mean from what was learnt around the same place, decibels: fading that is left, where the antenna points, and what
/// lies between pieces of floor.
const SIGMA_DB: f64 = 3.5;
/// A mean that is off by more deviations than this tells no more: somebody stands in the way.
const OFF_MAX: f64 = 3.0;
/// A place costs so much, in the score of a search, for each by which the mean square of the deviations is more than 1.
const COST: f64 = 0.08;
/// Fewer comparisons than this say nothing.
const COMPARED_MIN: usize = 4;

/// RssiFingerprints around a robot, in its own frame, and what was learnt of the home.
#[derive(Clone, Debug)]
pub(in super::super) struct FingerprintMatcher {
    around: Vec<(Point2, MeanRssi)>,
    map: Arc<FingerprintMap>,
}

impl FingerprintMatcher {
    pub(in super::super) fn new(around: Vec<(Point2, MeanRssi)>, map: Arc<FingerprintMap>) -> Self {
        Self { around, map }
    }

    /// What it costs a pose that it does not explain the strengths; 0 where nothing is known of them.
    pub(in super::super) fn cost(&self, pose: Pose2) -> f64 {
        let (mut squares, mut compared) = (0.0, 0_usize);
        for (place, level) in &self.around {
            let expected_dbm = self.map.expected_dbm(level.beacon, pose.transform(*place));
            // What is not known counts as well as what fits as usual, so that no place gains by being unknown.
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
