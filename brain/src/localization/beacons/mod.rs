//! Localization by ranges to radio beacons whose positions are unknown at first.
//!
//! *Hop*: the motion between two moments at which ranges are used. *Smoother*: solves the whole path so far for its poses, the errors
//! of the robot and the positions of the beacons ([`smoother`]). *Filter*: estimates all of these from there on, hop by hop
//! ([`filter`]), until the smoother has a better solution. Odometry gives the pose until it has the first one. Beacons that an earlier run
//! has located hold, and the robot is looked for between them ([`kept`]).
//!
//! Ranges have large errors: walls lengthen them, and some take a detour. So outliers have next to no weight, each beacon has a bias and
//! an error of its own that stays the same around a place, and a robot that turns on the spot learns nothing of that.

mod beacon;
mod filter;
mod hop;
mod kept;
mod located_range;
mod multilateration;
mod parameters;
mod range_prediction;
mod smoother;
mod weight;

use super::lift::Lift;
use crate::mapping::Keyframe;
use crate::model::advance::Advance;
use crate::model::geometry::Pose2;
use crate::model::known_beacon::KnownBeacon;
use crate::model::observation::Observation;
use crate::model::pose_estimate::PoseEstimate;
use filter::BeaconFilter;
use hop::{Anchor, Hop, HopBuilder, HopEnd, HopRange};
pub(crate) use kept::BeaconEvent;
use kept::KeptBeacons;
pub(super) use located_range::LocatedRange;
use parameters::{BATCH, HEADING, KNOWN, REDRAW};
use smoother::BatchSmoother;

/// Localization by beacons.
#[derive(Debug)]
pub(super) struct Beacons {
    gathering: HopBuilder,
    stage: BeaconStage,
    lift: Lift,
    located_ranges: Vec<LocatedRange>,
    tells_heading: bool,
    /// Beacons that an earlier run has located.
    known: Vec<KnownBeacon>,
    /// What was decided since it was asked last.
    events: Vec<BeaconEvent>,
    anchors: Anchors,
    drawing: Drawing,
}

/// Comparisons with the pose in a known map.
#[derive(Clone, Copy, Debug, Default)]
struct Anchors {
    since_m: f64,
    count: u32,
}

/// When the map was drawn again.
#[derive(Clone, Copy, Debug, Default)]
struct Drawing {
    began_us: u64,
    last_us: u64,
}

/// The present estimate, and where it comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct PriorEstimate {
    pub(super) estimate: PoseEstimate,
    /// A known map gives it, reliably.
    pub(super) is_by_map: bool,
}

#[derive(Debug)]
enum BeaconStage {
    /// No beacon was heard yet.
    Silent,
    Initializing(Box<BatchSmoother>),
    Following(Box<BeaconFilter>, Option<Box<BatchSmoother>>),
    /// Beacons of an earlier run are the reference.
    Kept(Box<KeptBeacons>),
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
            known: Vec::new(),
            events: Vec::new(),
            anchors: Anchors::default(),
            drawing: Drawing::default(),
        }
    }

    /// Begins with beacons that an earlier run has located, in the frame of the present map.
    pub(super) fn begin_with(&mut self, known: &[KnownBeacon]) {
        self.known = known.to_vec();
    }

    /// The beacons as they are worth keeping; `None` where they may not lie in the frame of the map.
    pub(super) fn to_keep(&self, is_by_map: bool) -> Option<Vec<KnownBeacon>> {
        let is_aligned = !is_by_map || self.anchors.count >= KNOWN.anchors_min;
        match &self.stage {
            BeaconStage::Following(filter, _) if self.tells_heading && is_aligned => Some(filter.known()),
            BeaconStage::Kept(kept) if self.tells_heading => Some(kept.to_keep()),
            _ => None,
        }
    }

    /// Better poses of the path so far with which the map should be drawn again, now and then.
    pub(super) fn redraw(&mut self, now_us: u64) -> Option<Vec<Keyframe>> {
        let BeaconStage::Following(_, Some(batch)) = &mut self.stage else {
            return None;
        };
        let Drawing { began_us, last_us } = self.drawing;
        let pause_us = REDRAW
            .every_us
            .max(last_us.saturating_sub(began_us) / REDRAW.elapsed_divisor);
        if now_us < last_us.max(began_us).saturating_add(pause_us) {
            return None;
        }
        let keyframes = batch.redraw()?;
        self.drawing.last_us = now_us;
        Some(keyframes)
    }

    /// Takes the motion and ranges of a step; `before` is the present estimate. Returns an estimate at the end of each hop once the
    /// beacons are located.
    pub(super) fn follow(
        &mut self,
        observation: &Observation,
        advance: Advance,
        before: PriorEstimate,
    ) -> Option<PoseEstimate> {
        self.located_ranges.clear();
        if self.drawing.began_us == 0 {
            self.drawing.began_us = observation.time_us;
        }
        if self.was_carried(observation, advance) {
            return None;
        }
        let hop = self.gathering.take(observation, advance);
        let followed = hop.and_then(|hop| {
            let hop = self.anchored(hop, before);
            self.use_hop(hop, before.estimate)
        });
        let estimate = self.go_on().or(followed);
        self.judge_heading(estimate);
        estimate
    }

    /// Goes on with a solution of the path, and adopts it.
    fn go_on(&mut self) -> Option<PoseEstimate> {
        match &mut self.stage {
            BeaconStage::Silent | BeaconStage::Carried | BeaconStage::Kept(_) => None,
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

    /// Adds to a hop where it ended by the other estimators.
    fn anchored(&mut self, hop: Hop, before: PriorEstimate) -> Hop {
        let PriorEstimate { estimate, is_by_map } = before;
        self.anchors.since_m += hop.length_m;
        let is_due = is_by_map && self.anchors.since_m >= KNOWN.anchor_every_m;
        if is_due {
            self.anchors.since_m = 0.0;
            self.anchors.count = self.anchors.count.saturating_add(1);
        }
        Hop {
            end: HopEnd {
                odom: estimate.odom,
                drawn: estimate.pose,
                ..hop.end
            },
            anchor: is_due.then_some(Anchor {
                pose: estimate.pose,
                sigma_m: estimate.sigma_m.max(KNOWN.anchor_sigma_min_m),
                sigma_rad: estimate.sigma_rad.max(KNOWN.anchor_sigma_min_rad),
            }),
            ..hop
        }
    }

    /// Begins between known beacons, if the robot hears some of them.
    fn begin_between_known(&mut self, hop: &Hop, before: PoseEstimate) -> bool {
        let is_known = |range: &&HopRange| self.known.iter().any(|known| known.number == range.beacon);
        let hears_enough = hop.ranges.iter().filter(is_known).count() >= BATCH.beacons_min;
        if hears_enough {
            self.stage = BeaconStage::Kept(Box::new(KeptBeacons::new(&self.known, before)));
        }
        hears_enough
    }

    fn use_hop(&mut self, hop: Hop, before: PoseEstimate) -> Option<PoseEstimate> {
        match &mut self.stage {
            BeaconStage::Carried => None,
            BeaconStage::Silent => {
                if self.begin_between_known(&hop, before) {
                    // The estimate is that at the end of this hop.
                    return self.use_kept(&Hop {
                        step: Pose2::IDENTITY,
                        ..hop
                    });
                }
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
            BeaconStage::Kept(_) => self.use_kept(&hop),
            BeaconStage::Following(filter, batch) => {
                filter.take(&hop);
                if let Some(number) = filter.forget_moved() {
                    self.events.push(BeaconEvent::Moved { number });
                }
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

    /// Follows a hop between known beacons.
    fn use_kept(&mut self, hop: &Hop) -> Option<PoseEstimate> {
        let BeaconStage::Kept(kept) = &mut self.stage else {
            return None;
        };
        let event = kept.take(hop);
        kept.locate_ranges(hop, &mut self.located_ranges);
        let estimate = kept.estimate();
        if kept.is_refuted() {
            let number_of = |known: KnownBeacon| known.number;
            let numbers = self.known.drain(..).map(number_of);
            self.events
                .extend(numbers.map(|number| BeaconEvent::Refuted { number }));
            self.stage = BeaconStage::Silent;
        }
        self.events.extend(event);
        estimate
    }

    /// Decides whether the heading is known well enough to draw a map.
    fn judge_heading(&mut self, estimate: Option<PoseEstimate>) {
        let sigma_max_rad = if self.tells_heading {
            HEADING.lost_sigma_rad
        } else {
            HEADING.known_sigma_rad
        };
        let is_confirmed = match &self.stage {
            BeaconStage::Kept(kept) => kept.is_confirmed(),
            _ => true,
        };
        self.tells_heading = is_confirmed
            && match estimate {
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
                BeaconStage::Kept(mut kept) => {
                    self.events.push(kept.lose());
                    BeaconStage::Kept(kept)
                }
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
        match &self.stage {
            BeaconStage::Following(..) => true,
            BeaconStage::Kept(kept) => !kept.is_searching(),
            BeaconStage::Silent | BeaconStage::Initializing(_) | BeaconStage::Carried => false,
        }
    }

    /// Whether the robot looks for its place between beacons.
    pub(super) fn is_searching(&self) -> bool {
        matches!(&self.stage, BeaconStage::Kept(kept) if kept.is_searching())
    }

    /// What was decided since the last call.
    pub(super) fn take_events(&mut self) -> Vec<BeaconEvent> {
        core::mem::take(&mut self.events)
    }

    /// Whether the place was found in this step.
    pub(super) fn has_found_place(&self) -> bool {
        let is_found = |event: &BeaconEvent| matches!(event, BeaconEvent::PlaceFound { .. });
        self.events.iter().any(is_found)
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
            BeaconStage::Kept(kept) => kept.place_at(pose),
            BeaconStage::Initializing(_) | BeaconStage::Carried => self.stage = BeaconStage::Silent,
            BeaconStage::Silent => {}
        }
    }

    /// Number, position and standard deviation in metres of each located beacon.
    #[cfg(test)]
    pub(super) fn places(&self) -> Vec<(u16, crate::model::geometry::Point2, f64)> {
        match &self.stage {
            BeaconStage::Following(follower, _) => follower.places(),
            BeaconStage::Kept(kept) => kept.places(),
            BeaconStage::Silent | BeaconStage::Initializing(_) | BeaconStage::Carried => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests;
