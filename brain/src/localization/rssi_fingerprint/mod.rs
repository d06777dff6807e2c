//! How strongly radio beacons are received where: what tells a robot that was carried away which part of the home it may be in.
//!
//! A strength is no distance. Walls and shadowing change it by 4 to 6 dB, which at the path loss of a home is half of any distance
//! that one would make of it, and all of it stays the same at a place however long one listens. So no distance is made. While
//! the robot knows its place it keeps the mean strength of each beacon for each piece of floor ([`FingerprintMap`]), in which walls,
//! power and exponent are contained; a lost robot compares with that what it has received lately ([`FingerprintMatcher`]). Nothing is known of
//! where beacons are, and no heading and no place of a robot that is not lost ever follows from strengths.

mod averager;
mod map;
mod matcher;
mod mean_rssi;
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

/// What is received now, and what was learnt of the home.
#[derive(Clone, Debug, Default)]
pub(super) struct RssiFingerprints {
    gathering: RssiAverager,
    map: Arc<FingerprintMap>,
    fresh: Vec<MeanRssi>,
}

impl RssiFingerprints {
    /// Takes in what was received on a step; [`Self::fresh`] tells whether a short way ended with it.
    pub(super) fn listen(&mut self, observation: &Observation, advance: Advance) {
        self.fresh.clear();
        self.gathering.take(observation, advance, &mut self.fresh);
    }

    /// Means of the way that has just ended; empty between.
    pub(super) fn fresh(&self) -> &[MeanRssi] {
        &self.fresh
    }

    /// What is fresh was received here, by a robot that knows it.
    pub(super) fn learn(&mut self, at: Point2) {
        if !self.fresh.is_empty() {
            Arc::make_mut(&mut self.map).learn(at, &self.fresh);
        }
    }

    /// Nothing was learnt yet.
    pub(super) fn is_empty(&self) -> bool {
        self.map.is_empty()
    }

    /// What was learnt of the home.
    pub(super) fn map(&self) -> Arc<FingerprintMap> {
        Arc::clone(&self.map)
    }
}
