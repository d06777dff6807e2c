//! Where the robot is by its distances to radio beacons whose places nobody has told.
//!
//! Terms. *Hop*: the motion between two moments at which ranges are taken in. *First look*: the first metres, kept whole
//! and solved at once for the way, the wheels' errors and the places of the beacons ([`initialization`]). *BeaconFilter*: what
//! carries all of these on from there, hop by hop ([`filter`]). Until the first look has an answer the robot goes by its
//! odometry.
//!
//! Ranges lie: walls lengthen them, and some come by a detour. So what is far off counts little, and what is measured
//! twenty times at one place counts as little more than once.

mod filter;
mod hop;
mod initialization;
mod located_range;
mod multilateration;
mod range_prediction;
mod weight;

use crate::model::advance::Advance;
use crate::model::geometry::Pose2;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;
use filter::BeaconFilter;
use hop::HopBuilder;
use initialization::BatchInitializer;
pub(super) use located_range::LocatedRange;

/// Wheels that hang for so long hang because somebody carries the robot, seconds.
const CARRIED_S: f64 = 1.0;

/// Pose by beacons.
#[derive(Clone, Debug)]
pub(super) struct Beacons {
    gathering: HopBuilder,
    stage: BeaconStage,
    hanging_s: f64,
    heard: Vec<LocatedRange>,
}

#[derive(Clone, Debug)]
enum BeaconStage {
    /// No beacon was heard yet.
    Silent,
    Initializing(Box<BatchInitializer>),
    Following(Box<BeaconFilter>),
    /// Somebody carried the robot: where to is not known.
    Carried,
}

impl Beacons {
    pub(super) fn new() -> Self {
        Self {
            gathering: HopBuilder::default(),
            stage: BeaconStage::Silent,
            hanging_s: 0.0,
            heard: Vec::new(),
        }
    }

    /// Takes in what the robot moved and heard; `before` is where it believes to be. Gives the estimate at the end of each
    /// hop once the beacons are known.
    pub(super) fn follow(
        &mut self,
        observation: &Observation,
        advance: Advance,
        before: PoseEstimate,
    ) -> Option<PoseEstimate> {
        self.heard.clear();
        if self.was_carried(observation, advance) {
            return None;
        }
        let hop = self.gathering.take(observation, advance)?;
        match &mut self.stage {
            BeaconStage::Carried => None,
            BeaconStage::Silent => {
                if !hop.ranges.is_empty() {
                    self.stage = BeaconStage::Initializing(Box::new(BatchInitializer::new(before)));
                }
                None
            }
            BeaconStage::Initializing(look) => {
                let Some(found) = look.take(hop) else {
                    if look.is_hopeless() {
                        **look = BatchInitializer::new(before);
                    }
                    return None;
                };
                let estimate = found.estimate();
                self.stage = BeaconStage::Following(Box::new(found));
                Some(estimate)
            }
            BeaconStage::Following(follower) => {
                follower.take(&hop);
                follower.hear(&hop, &mut self.heard);
                Some(follower.estimate())
            }
        }
    }

    fn was_carried(&mut self, observation: &Observation, advance: Advance) -> bool {
        if observation.wheel_drop {
            self.hanging_s += advance.time_s;
            return true;
        }
        let carried = self.hanging_s >= CARRIED_S;
        self.hanging_s = 0.0;
        if carried {
            self.gathering = HopBuilder::default();
            self.stage = match core::mem::replace(&mut self.stage, BeaconStage::Silent) {
                BeaconStage::Silent => BeaconStage::Silent,
                BeaconStage::Initializing(_) | BeaconStage::Following(_) | BeaconStage::Carried => {
                    BeaconStage::Carried
                }
            };
        }
        carried
    }

    /// Whether there are beacons at all.
    pub(super) fn are_heard(&self) -> bool {
        !matches!(self.stage, BeaconStage::Silent)
    }

    /// Whether the way of the robot follows from beacons.
    pub(super) fn is_following(&self) -> bool {
        matches!(self.stage, BeaconStage::Following(_))
    }

    /// What the last hop heard of beacons whose places are known; empty between hops.
    pub(super) fn heard(&self) -> &[LocatedRange] {
        &self.heard
    }

    /// Somebody who knows better says where the robot is.
    pub(super) fn place_at(&mut self, pose: Pose2) {
        match &mut self.stage {
            BeaconStage::Following(follower) => follower.place_at(pose),
            BeaconStage::Initializing(_) | BeaconStage::Carried => self.stage = BeaconStage::Silent,
            BeaconStage::Silent => {}
        }
    }

    /// Numbers and places of the beacons that are known, and how sure they are, metres.
    #[cfg(test)]
    pub(super) fn places(&self) -> Vec<(u16, crate::model::geometry::Point2, f64)> {
        match &self.stage {
            BeaconStage::Following(follower) => follower.places(),
            BeaconStage::Silent | BeaconStage::Initializing(_) | BeaconStage::Carried => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests;
