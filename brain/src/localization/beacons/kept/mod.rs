//! Localization between kept beacons: those that earlier runs have located. They are the reference and hold exactly.
//!
//! Several hypotheses are tracked beside each other (multiple hypothesis tracking): that all beacons are where they were, and of each one
//! that somebody has moved it. Where none of them explains the ranges, the robot is elsewhere: hypotheses all over the place of the
//! beacons join them until one is left. Only a beacon that contradicts the others is forgotten; if no pose agrees with the beacons, all are.

mod hypothesis;
mod parameters;
mod seeds;

use std::collections::VecDeque;

use super::filter::BeaconFilter;
use super::hop::Hop;
use super::located_range::LocatedRange;
use super::parameters::KNOWN;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::known_beacon::KnownBeacon;
use crate::model::pose_estimate::PoseEstimate;
use hypothesis::PlaceHypothesis;
use parameters::{DOUBT, MOVED, SEARCH};

/// The filters of a robot that knows its beacons from earlier runs.
#[derive(Debug)]
pub(super) struct KeptBeacons {
    reference: Vec<KnownBeacon>,
    /// The first one says that all beacons are where they were.
    tracked: Vec<PlaceHypothesis>,
    /// Index of the one that counts.
    active: usize,
    search: Option<PlaceSearch>,
    /// The latest hops.
    recent: VecDeque<Hop>,
    /// Number of ranges so far.
    heard: u32,
}

/// Hypotheses that the robot is elsewhere.
#[derive(Debug, Default)]
struct PlaceSearch {
    elsewhere: Vec<PlaceHypothesis>,
    driven_m: f64,
}

/// What a hop has decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BeaconEvent {
    /// Somebody has carried the robot.
    Carried,
    /// The place contradicts the beacons.
    SearchPlace,
    /// It is known again, after so many metres.
    PlaceFound { driven_m: f64 },
    /// Somebody has moved this beacon.
    Moved { number: u16 },
    /// No place agrees with the beacons, of which this is one.
    Refuted { number: u16 },
}

impl KeptBeacons {
    /// Begins between these beacons at a pose.
    pub(super) fn new(reference: &[KnownBeacon], start: PoseEstimate) -> Self {
        let mut kept = Self {
            reference: reference.to_vec(),
            tracked: Vec::new(),
            active: 0,
            search: None,
            recent: VecDeque::new(),
            heard: 0,
        };
        kept.track(BeaconFilter::between(reference, start));
        kept
    }

    /// Tracks the pose of a filter with all beacons, and beside it without each of them.
    fn track(&mut self, filter: BeaconFilter) {
        let without = |known: &KnownBeacon| PlaceHypothesis::without(&filter, known);
        self.tracked = if self.reference.len() < KNOWN.others_min {
            Vec::new()
        } else {
            self.reference.iter().filter_map(without).collect()
        };
        self.tracked.insert(0, PlaceHypothesis::new(filter, 0.0));
        self.active = 0;
    }

    /// Takes a hop.
    pub(super) fn take(&mut self, hop: &Hop) -> Option<BeaconEvent> {
        let hop = Hop {
            anchor: None,
            ..hop.clone()
        };
        let is_kept = |number: u16| self.reference.iter().any(|known| known.number == number);
        let heard = hop.ranges.iter().filter(|range| is_kept(range.beacon)).count();
        self.heard = self
            .heard
            .saturating_add(u32::try_from(heard).unwrap_or(u32::MAX));
        for hypothesis in &mut self.tracked {
            hypothesis.take(&hop);
        }
        let event = if let Some(search) = &mut self.search {
            search.take(&hop, heard);
            if search.elsewhere.is_empty()
                && let Some((elsewhere, _)) = self.seeded(&[&hop])
                && let Some(search) = &mut self.search
            {
                search.elsewhere = elsewhere;
            }
            self.end_search()
        } else {
            self.choose();
            self.moved().or_else(|| self.doubt(&hop))
        };
        self.recent.push_back(hop);
        if self.recent.len() > SEARCH.recent_hops {
            self.recent.pop_front();
        }
        event
    }

    /// Follows the hypothesis that explains the ranges best.
    fn choose(&mut self) {
        let cost = |index: usize| self.tracked.get(index).map_or(f64::INFINITY, |one| one.cost);
        let best = (0..self.tracked.len()).min_by(|one, other| cost(*one).total_cmp(&cost(*other)));
        if let Some(best) = best
            && cost(best) + MOVED.switch_lead < cost(self.active)
        {
            self.active = best;
        }
    }

    /// A beacon whose ranges contradict those of all others, and agree with another place of it.
    fn moved(&mut self) -> Option<BeaconEvent> {
        let all = self.tracked.first()?.cost;
        let index = (1..self.tracked.len()).find(|index| self.proves_move(*index, all))?;
        let PlaceHypothesis { filter, left_out, .. } = self.tracked.swap_remove(index);
        let number = left_out?.number;
        self.reference.retain(|known| known.number != number);
        self.track(filter);
        Some(BeaconEvent::Moved { number })
    }

    /// Whether the hypothesis of this index proves that its beacon was moved, where the one of no moved beacon costs so much: it explains
    /// the ranges better than all others do, or only its beacon is located elsewhere than it was.
    fn proves_move(&self, index: usize, all: f64) -> bool {
        let Some(own) = self.tracked.get(index) else {
            return false;
        };
        let Some(displacement) = own.displacement().filter(|displacement| displacement.is_sure()) else {
            return false;
        };
        let others = || {
            let tracked = self.tracked.iter().enumerate().skip(1);
            tracked
                .filter(|(other, _)| *other != index)
                .map(|(_, other)| other)
        };
        let gain = all - own.cost;
        let leads = gain >= MOVED.gain && others().all(|other| own.cost + MOVED.lead <= other.cost);
        let stands_out =
            gain >= MOVED.gain_min && others().all(|other| displacement.outweighs(other.displacement()));
        leads || stands_out
    }

    /// Begins a search where no hypothesis explains the ranges.
    fn doubt(&mut self, hop: &Hop) -> Option<BeaconEvent> {
        let is_explained = self
            .tracked
            .iter()
            .any(|hypothesis| hypothesis.lately <= DOUBT.lately_max);
        if is_explained || self.heard < DOUBT.heard_min {
            return None;
        }
        let hops: Vec<&Hop> = self.recent.iter().chain([hop]).collect();
        let (elsewhere, heard) = self.seeded(&hops)?;
        for hypothesis in &mut self.tracked {
            hypothesis.cost = hypothesis.lately * heard as f64;
        }
        self.search = Some(PlaceSearch {
            elsewhere,
            driven_m: 0.0,
        });
        Some(BeaconEvent::SearchPlace)
    }

    /// Hypotheses all over the place after these hops, and the number of ranges that they have seen.
    fn seeded(&self, hops: &[&Hop]) -> Option<(Vec<PlaceHypothesis>, usize)> {
        let enough = KNOWN.others_min.min(self.reference.len());
        let first = hops
            .iter()
            .position(|hop| seeds::count(&self.reference, hop) >= enough)?;
        let hops = hops.get(first..)?;
        let follow = |start: PoseEstimate| {
            let filter = BeaconFilter::between(&self.reference, start);
            let mut hypothesis = PlaceHypothesis::new(filter, SEARCH.prior_cost);
            for (number, hop) in hops.iter().enumerate() {
                // The first hop ended there.
                let step = if number == 0 { Pose2::IDENTITY } else { hop.step };
                hypothesis.take(&Hop {
                    step,
                    ..(*hop).clone()
                });
            }
            hypothesis
        };
        let starts = seeds::poses(&self.reference, hops.first()?);
        let heard = hops.iter().map(|hop| seeds::count(&self.reference, hop)).sum();
        Some((starts.into_iter().map(follow).collect(), heard))
    }

    /// Somebody has carried the robot elsewhere.
    pub(super) fn lose(&mut self) -> BeaconEvent {
        self.recent.clear();
        for hypothesis in &mut self.tracked {
            hypothesis.cost = SEARCH.carried_cost;
        }
        self.search = Some(PlaceSearch::default());
        BeaconEvent::Carried
    }

    /// Ends a search that has found the place.
    fn end_search(&mut self) -> Option<BeaconEvent> {
        let search = self.search.as_ref()?;
        let driven_m = search.driven_m;
        let all = || self.tracked.iter().chain(&search.elsewhere);
        let best = all().min_by(|one, other| one.cost.total_cmp(&other.cost))?;
        let is_rival =
            |other: &&PlaceHypothesis| other.cost < best.cost + SEARCH.lead && !is_same(best, other);
        let is_found = !search.elsewhere.is_empty()
            && best.is_sure()
            && best.lately <= DOUBT.lately_max
            && !all().any(|other| is_rival(&other));
        if is_found && driven_m >= SEARCH.driven_min_m {
            let is_elsewhere = search.elsewhere.iter().any(|other| core::ptr::eq(other, best));
            let filter = best.filter.clone();
            self.search = None;
            if is_elsewhere {
                self.track(filter);
            } else {
                self.choose();
            }
            return Some(BeaconEvent::PlaceFound { driven_m });
        }
        None
    }

    /// Whether no place agrees with the beacons.
    pub(super) fn is_refuted(&self) -> bool {
        let is_long = |search: &PlaceSearch| search.driven_m >= SEARCH.driven_max_m;
        self.search.as_ref().is_some_and(is_long)
    }

    /// The pose; `None` while it is searched for.
    pub(super) fn estimate(&self) -> Option<PoseEstimate> {
        let active = self.tracked.get(self.active)?;
        self.search.is_none().then(|| active.filter.estimate())
    }

    /// Whether the place is searched for.
    pub(super) const fn is_searching(&self) -> bool {
        self.search.is_some()
    }

    /// Whether enough ranges agree with the place.
    pub(super) const fn is_confirmed(&self) -> bool {
        self.search.is_none() && self.heard >= DOUBT.confirmed_min
    }

    /// Ranges of a hop to located beacons. The places of kept beacons hold wherever the robot is.
    pub(super) fn locate_ranges(&self, hop: &Hop, located_ranges: &mut Vec<LocatedRange>) {
        if let Some(active) = self.tracked.get(self.active) {
            active.filter.locate_ranges(hop, located_ranges);
        }
    }

    /// Another estimator gives the pose.
    pub(super) fn place_at(&mut self, pose: Pose2) {
        self.search = None;
        self.recent.clear();
        self.heard = 0;
        for hypothesis in &mut self.tracked {
            hypothesis.restart_at(pose);
        }
    }

    /// The kept beacons as they were, and those that were located since.
    pub(super) fn to_keep(&self) -> Vec<KnownBeacon> {
        let mut known = self.reference.clone();
        if let Some(first) = self.tracked.first() {
            let is_new = |new: &KnownBeacon| self.reference.iter().all(|old| old.number != new.number);
            known.extend(first.filter.known().into_iter().filter(is_new));
        }
        known
    }

    /// Number, position and standard deviation in metres of each located beacon.
    #[cfg(test)]
    pub(super) fn places(&self) -> Vec<(u16, crate::model::geometry::Point2, f64)> {
        self.tracked
            .first()
            .map_or_else(Vec::new, |first| first.filter.places())
    }
}

impl PlaceSearch {
    /// Takes a hop with so many ranges to kept beacons.
    fn take(&mut self, hop: &Hop, heard: usize) {
        if heard > 0 {
            self.driven_m += hop.length_m;
        }
        for hypothesis in &mut self.elsewhere {
            hypothesis.take(hop);
        }
        self.elsewhere
            .sort_by(|one, other| one.cost.total_cmp(&other.cost));
        let best = self.elsewhere.first().map_or(0.0, |best| best.cost);
        let mut distinct: Vec<PlaceHypothesis> = Vec::new();
        for hypothesis in self.elsewhere.drain(..) {
            let is_hopeful = hypothesis.cost <= best + SEARCH.hopeless;
            if is_hopeful && distinct.iter().all(|better| !is_merged(better, &hypothesis)) {
                distinct.push(hypothesis);
            }
        }
        self.elsewhere = distinct;
    }
}

/// Distance and turn between two hypotheses.
fn apart(one: &PlaceHypothesis, other: &PlaceHypothesis) -> (f64, f64) {
    let (one, other) = (one.filter.estimate().pose, other.filter.estimate().pose);
    let turned_rad = normalize_rad(one.heading_rad - other.heading_rad).abs();
    (one.position().distance_m(other.position()), turned_rad)
}

/// Whether two hypotheses are one place to somebody who asks where the robot is.
fn is_same(one: &PlaceHypothesis, other: &PlaceHypothesis) -> bool {
    let (away_m, turned_rad) = apart(one, other);
    away_m < SEARCH.same_m && turned_rad < SEARCH.same_rad
}

/// Whether two hypotheses have become one.
fn is_merged(one: &PlaceHypothesis, other: &PlaceHypothesis) -> bool {
    let (away_m, turned_rad) = apart(one, other);
    away_m < SEARCH.merged_m && turned_rad < SEARCH.merged_rad
}
