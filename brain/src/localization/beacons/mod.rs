//! Where the robot is by its distances to radio beacons whose places nobody has told.
//!
//! Terms. *Hop*: the motion between two moments at which ranges are taken in. *First look*: the first metres, kept whole
//! and solved at once for the way, the wheels' errors and the places of the beacons ([`first_look`]). *Follower*: what
//! carries all of these on from there, hop by hop ([`follower`]). Until the first look has an answer the robot goes by its
//! odometry.
//!
//! Ranges lie: walls lengthen them, and some come by a detour. So what is far off counts little, and what is measured
//! twenty times at one place counts as little more than once.

mod first_look;
mod follower;
mod guess;
mod heard;
mod hop;
mod sight;
mod weight;

use crate::model::advance::Advance;
use crate::model::geometry::Pose2;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;
use first_look::FirstLook;
use follower::Follower;
pub(super) use heard::Heard;
use hop::Gathering;

/// Wheels that hang for so long hang because somebody carries the robot, seconds.
const CARRIED_S: f64 = 1.0;

/// Pose by beacons.
#[derive(Clone, Debug)]
pub(super) struct Beacons {
    gathering: Gathering,
    stage: Stage,
    hanging_s: f64,
    heard: Vec<Heard>,
}

#[derive(Clone, Debug)]
enum Stage {
    /// No beacon was heard yet.
    Silent,
    Looking(Box<FirstLook>),
    Following(Box<Follower>),
    /// Somebody carried the robot: where to is not known.
    Carried,
}

impl Beacons {
    pub(super) fn new() -> Self {
        Self {
            gathering: Gathering::default(),
            stage: Stage::Silent,
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
            Stage::Carried => None,
            Stage::Silent => {
                if !hop.ranges.is_empty() {
                    self.stage = Stage::Looking(Box::new(FirstLook::new(before)));
                }
                None
            }
            Stage::Looking(look) => {
                let Some(found) = look.take(hop) else {
                    if look.is_hopeless() {
                        **look = FirstLook::new(before);
                    }
                    return None;
                };
                let estimate = found.estimate();
                self.stage = Stage::Following(Box::new(found));
                Some(estimate)
            }
            Stage::Following(follower) => {
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
            self.gathering = Gathering::default();
            self.stage = match core::mem::replace(&mut self.stage, Stage::Silent) {
                Stage::Silent => Stage::Silent,
                Stage::Looking(_) | Stage::Following(_) | Stage::Carried => Stage::Carried,
            };
        }
        carried
    }

    /// Whether there are beacons at all.
    pub(super) fn are_heard(&self) -> bool {
        !matches!(self.stage, Stage::Silent)
    }

    /// Whether the way of the robot follows from beacons.
    pub(super) fn is_following(&self) -> bool {
        matches!(self.stage, Stage::Following(_))
    }

    /// What the last hop heard of beacons whose places are known; empty between hops.
    pub(super) fn heard(&self) -> &[Heard] {
        &self.heard
    }

    /// Somebody who knows better says where the robot is.
    pub(super) fn place_at(&mut self, pose: Pose2) {
        match &mut self.stage {
            Stage::Following(follower) => follower.place_at(pose),
            Stage::Looking(_) | Stage::Carried => self.stage = Stage::Silent,
            Stage::Silent => {}
        }
    }

    /// Numbers and places of the beacons that are known, and how sure they are, metres.
    #[cfg(test)]
    pub(super) fn places(&self) -> Vec<(u16, crate::model::geometry::Point2, f64)> {
        match &self.stage {
            Stage::Following(follower) => follower.places(),
            Stage::Silent | Stage::Looking(_) | Stage::Carried => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests;
