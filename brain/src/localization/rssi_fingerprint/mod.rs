//! RSSI fingerprints: how strongly radio beacons are received where. They tell a robot that was carried away in which part of the
//! home it may be.
//!
//! A signal strength is no distance. Walls and shadowing change it by 4 to 6 dB. At the path loss of a home that is half of any
//! distance computed from it, and the error stays the same at a place however long the robot listens. While its pose is known, the
//! robot keeps the mean strength of each beacon for each cell of the floor ([`FingerprintMap`]), which contains walls, power and
//! exponent. A lost robot compares what it has received lately with that ([`FingerprintMatcher`]). Positions of beacons stay
//! unknown. No heading follows from signal strengths, and no position of a robot that is not lost.

mod averager;
mod map;
mod matcher;
mod mean_rssi;
mod parameters;
#[cfg(test)]
mod tests;

use std::sync::Arc;

pub(super) use map::FingerprintMap;
pub(super) use matcher::FingerprintMatcher;
pub(super) use mean_rssi::MeanRssi;

use crate::model::advance::Advance;
use crate::model::geometry::Point2;
use crate::model::observation::Observation;
use averager::RssiAverager;

/// Present signal strengths, and the fingerprints of the home.
#[derive(Clone, Debug, Default)]
pub(super) struct RssiFingerprints {
    gathering: RssiAverager,
    map: Arc<FingerprintMap>,
    fresh: Vec<MeanRssi>,
}

impl RssiFingerprints {
    /// Takes the signals of a step; [`Self::fresh`] has the means when a short path ended with it.
    pub(super) fn listen(&mut self, observation: &Observation, advance: Advance) {
        self.fresh.clear();
        self.gathering.take(observation, advance, &mut self.fresh);
    }

    /// Means of the short path that has just ended; empty between.
    pub(super) fn fresh(&self) -> &[MeanRssi] {
        &self.fresh
    }

    /// Learns the fresh means at this position.
    pub(super) fn learn(&mut self, at: Point2) {
        if !self.fresh.is_empty() {
            Arc::make_mut(&mut self.map).learn(at, &self.fresh);
        }
    }

    /// Nothing was learned yet.
    pub(super) fn is_empty(&self) -> bool {
        self.map.is_empty()
    }

    /// The fingerprints of the home.
    pub(super) fn map(&self) -> Arc<FingerprintMap> {
        Arc::clone(&self.map)
    }
}
