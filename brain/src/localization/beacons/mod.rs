//! Localization by ranges to radio beacons whose positions are unknown at first.
//!
//! *Hop*: the motion between two moments at which ranges are used. *Initialization*: the first metres, solved as one batch for the
//! path, the wheels' errors and the positions of the beacons ([`initialization`]). *Filter*: estimates all of these from there on,
//! hop by hop ([`filter`]). Odometry gives the pose until the initialization has a solution.
//!
//! Ranges have large errors: walls lengthen them, and some take a detour. So outliers have little weight, and twenty ranges at one
//! place count little more than one.

mod filter;
mod hop;
mod initialization;
mod located_range;
mod multilateration;
mod parameters;
mod range_prediction;
mod weight;

use super::lift::Lift;
use crate::model::advance::Advance;
use crate::model::geometry::Pose2;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;
use filter::BeaconFilter;
use hop::HopBuilder;
use initialization::BatchInitializer;
pub(super) use located_range::LocatedRange;

/// Localization by beacons.
#[derive(Clone, Debug)]
pub(super) struct Beacons {
    gathering: HopBuilder,
    stage: BeaconStage,
    lift: Lift,
    located_ranges: Vec<LocatedRange>,
}

#[derive(Clone, Debug)]
enum BeaconStage {
    /// No beacon was heard yet.
    Silent,
    Initializing(Box<BatchInitializer>),
    Following(Box<BeaconFilter>),
    /// Somebody carried the robot to an unknown place.
    Carried,
}

impl Beacons {
    pub(super) fn new() -> Self {
        Self {
            gathering: HopBuilder::default(),
            stage: BeaconStage::Silent,
            lift: Lift::default(),
            located_ranges: Vec::new(),
        }
    }

    /// Takes the motion and ranges of a step; `before` is the present estimate. Returns an estimate at the end of each hop once the
    /// beacons are located.
    pub(super) fn follow(
        &mut self,
        observation: &Observation,
        advance: Advance,
        before: PoseEstimate,
    ) -> Option<PoseEstimate> {
        self.located_ranges.clear();
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
            BeaconStage::Initializing(batch) => {
                let Some(found) = batch.take(hop) else {
                    if batch.is_hopeless() {
                        **batch = BatchInitializer::new(before);
                    }
                    return None;
                };
                let estimate = found.estimate();
                self.stage = BeaconStage::Following(Box::new(found));
                Some(estimate)
            }
            BeaconStage::Following(follower) => {
                follower.take(&hop);
                follower.locate_ranges(&hop, &mut self.located_ranges);
                Some(follower.estimate())
            }
        }
    }

    fn was_carried(&mut self, observation: &Observation, advance: Advance) -> bool {
        self.lift.update(observation, advance);
        if observation.wheel_drop {
            return true;
        }
        let carried = self.lift.is_put_down();
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

    /// Whether beacons determine the pose.
    pub(super) fn is_following(&self) -> bool {
        matches!(self.stage, BeaconStage::Following(_))
    }

    /// Ranges of the last hop to located beacons; empty between hops.
    pub(super) fn located_ranges(&self) -> &[LocatedRange] {
        &self.located_ranges
    }

    /// Another estimator gives the pose.
    pub(super) fn place_at(&mut self, pose: Pose2) {
        match &mut self.stage {
            BeaconStage::Following(follower) => follower.place_at(pose),
            BeaconStage::Initializing(_) | BeaconStage::Carried => self.stage = BeaconStage::Silent,
            BeaconStage::Silent => {}
        }
    }

    /// Number, position and standard deviation in metres of each located beacon.
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
