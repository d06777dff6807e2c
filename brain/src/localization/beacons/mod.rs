//! Localization by ranges to radio beacons whose positions are unknown at first.
//!
//! *Hop*: the motion between two moments at which ranges are used. *Smoother*: solves the whole path so far for its poses, the errors
//! of the robot and the positions of the beacons ([`smoother`]). *Filter*: estimates all of these from there on, hop by hop
//! ([`filter`]), until the smoother has a better solution. Odometry gives the pose until it has the first one.
//!
//! Ranges have large errors: walls lengthen them, and some take a detour. So outliers have next to no weight, each beacon has a bias and
//! an error of its own that stays the same around a place, and a robot that turns on the spot learns nothing of that.

mod beacon;
mod filter;
mod hop;
mod located_range;
mod multilateration;
mod parameters;
mod range_prediction;
mod smoother;
mod weight;

use super::lift::Lift;
use crate::model::advance::Advance;
use crate::model::geometry::Pose2;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;
use filter::BeaconFilter;
use hop::{Hop, HopBuilder};
pub(super) use located_range::LocatedRange;
use parameters::HEADING;
use smoother::BatchSmoother;

/// Localization by beacons.
#[derive(Debug)]
pub(super) struct Beacons {
    gathering: HopBuilder,
    stage: BeaconStage,
    lift: Lift,
    located_ranges: Vec<LocatedRange>,
    tells_heading: bool,
}

#[derive(Debug)]
enum BeaconStage {
    /// No beacon was heard yet.
    Silent,
    Initializing(Box<BatchSmoother>),
    Following(Box<BeaconFilter>, Option<Box<BatchSmoother>>),
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
            tells_heading: false,
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
        let hop = self.gathering.take(observation, advance);
        let followed = hop.and_then(|hop| self.use_hop(hop, before));
        let estimate = self.go_on().or(followed);
        self.judge_heading(estimate);
        estimate
    }

    /// Goes on with a solution of the path, and adopts it.
    fn go_on(&mut self) -> Option<PoseEstimate> {
        match &mut self.stage {
            BeaconStage::Silent | BeaconStage::Carried => None,
            BeaconStage::Initializing(batch) => {
                let found = batch.go_on()?;
                let estimate = self.gathering.ahead_of(found.estimate());
                let BeaconStage::Initializing(batch) =
                    core::mem::replace(&mut self.stage, BeaconStage::Silent)
                else {
                    return None;
                };
                self.stage = BeaconStage::Following(Box::new(found), Some(batch));
                Some(estimate)
            }
            BeaconStage::Following(filter, batch) => {
                **filter = batch.as_mut()?.go_on()?;
                Some(self.gathering.ahead_of(filter.estimate()))
            }
        }
    }

    fn use_hop(&mut self, hop: Hop, before: PoseEstimate) -> Option<PoseEstimate> {
        match &mut self.stage {
            BeaconStage::Carried => None,
            BeaconStage::Silent => {
                if !hop.ranges.is_empty() {
                    self.stage = BeaconStage::Initializing(Box::new(BatchSmoother::new(before)));
                }
                None
            }
            BeaconStage::Initializing(batch) => {
                batch.take(hop);
                if batch.is_hopeless() {
                    **batch = BatchSmoother::new(before);
                }
                None
            }
            BeaconStage::Following(filter, batch) => {
                filter.take(&hop);
                filter.locate_ranges(&hop, &mut self.located_ranges);
                let estimate = filter.estimate();
                if batch.as_ref().is_some_and(|batch| batch.is_long()) {
                    *batch = None;
                }
                if let Some(batch) = batch {
                    batch.take(hop);
                }
                Some(estimate)
            }
        }
    }

    /// Decides whether the heading is known well enough to draw a map.
    fn judge_heading(&mut self, estimate: Option<PoseEstimate>) {
        let sigma_max_rad = if self.tells_heading {
            HEADING.lost_sigma_rad
        } else {
            HEADING.known_sigma_rad
        };
        self.tells_heading = match estimate {
            Some(estimate) => estimate.sigma_rad <= sigma_max_rad,
            None => self.tells_heading && self.is_following(),
        };
    }

    /// Whether the heading is known well enough to draw a map.
    pub(super) const fn tell_heading(&self) -> bool {
        self.tells_heading
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
                BeaconStage::Initializing(_) | BeaconStage::Following(..) | BeaconStage::Carried => {
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
        matches!(self.stage, BeaconStage::Following(..))
    }

    /// Ranges of the last hop to located beacons; empty between hops.
    pub(super) fn located_ranges(&self) -> &[LocatedRange] {
        &self.located_ranges
    }

    /// Another estimator gives the pose.
    pub(super) fn place_at(&mut self, pose: Pose2) {
        match &mut self.stage {
            BeaconStage::Following(follower, batch) => {
                follower.place_at(pose);
                *batch = None;
            }
            BeaconStage::Initializing(_) | BeaconStage::Carried => self.stage = BeaconStage::Silent,
            BeaconStage::Silent => {}
        }
    }

    /// Number, position and standard deviation in metres of each located beacon.
    #[cfg(test)]
    pub(super) fn places(&self) -> Vec<(u16, crate::model::geometry::Point2, f64)> {
        match &self.stage {
            BeaconStage::Following(follower, _) => follower.places(),
            BeaconStage::Silent | BeaconStage::Initializing(_) | BeaconStage::Carried => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests;
