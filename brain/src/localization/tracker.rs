//! Monte Carlo localization over time: when to move and weigh the particle filter, and how far to trust its estimate.
//!
//! A robot is *lost* when the map does not explain its observations, or when somebody has lifted it. Then the particles are spread
//! over all free floor. It is *found* when one cluster of particles remains that the map explains.

mod drift_check;
mod known_space;
mod parameters;

use known_space::Whole;
use parameters::{SEARCH, TRACKING};

use super::beacons::LocatedRange;
use super::candidates::{is_alone, is_among, near_if_as_good};
use super::confidence::{Confidence, Verdict};
use super::dead_reckoning::DeadReckoning;
use super::drift::{ODOMETRY_NOISE, turn_variance};
use super::global_localizer::{GlobalLocalizer, PoseCandidate};
use super::gyro_estimate::{BiasMeasurement, GyroEstimate};
use super::lift::Lift;
use super::lost_share::LostShare;
use super::map_check::MapCheck;
use super::odometry::Odometry;
use super::particles::{
    BeamScore, FilterMode, Measurements, MotionDelta, ParticleFilter, PoseSpread, Surroundings,
};
use super::rssi_fingerprint::{FingerprintMap, FingerprintMatcher, RssiFingerprints};
use super::scan_history::ScanHistory;
use super::standstill::Standstill;
use crate::model::advance::Advance;
use crate::model::map_doubt::MapDoubt;
use crate::model::pose_estimate::PoseEstimate;
use std::sync::Arc;

use crate::model::config::SensorLayout;
use crate::model::geometry::Pose2;
use crate::model::observation::Observation;
use crate::model::onsets::Onsets;

/// With fewer proximity sensors than this a robot with odometry cannot keep its pose in a map: in experiments it was metres off
/// within minutes.
pub(super) const SENSORS_MIN: usize = 3;
/// Number of informative beams after which a found pose counts as confirmed. Until then it must not lie in unknown space: global
/// localization searches known space only, and a wrong pose leads out of it soon.
pub(super) const CONFIRMATION_BEAMS: u32 = 200;
/// Dead reckoning that is this far from the particles contradicts them, metres: several times its error.
const CONTRADICTION_M: f64 = 0.5;

/// The motion of a step, and the estimate.
#[derive(Clone, Copy, Debug)]
pub(super) struct MotionUpdate {
    pub(super) advance: Advance,
    /// Pose by odometry since the last estimate.
    pub(super) pose: Pose2,
    /// The calibration with which odometry corrected the gyro.
    pub(super) gyro: GyroEstimate,
    /// Bias by a zero-velocity update that has just ended.
    pub(super) measured_bias: Option<BiasMeasurement>,
}

impl MotionUpdate {
    /// The last step of odometry.
    pub(super) fn of(odometry: &Odometry, advance: Advance, pose: Pose2) -> Self {
        Self {
            advance,
            pose,
            gyro: odometry.calibration.belief(),
            measured_bias: odometry.measured_bias(),
        }
    }
}

/// Monte Carlo localization of a robot in a map.
#[derive(Clone, Debug)]
pub(super) struct Tracker {
    filter: ParticleFilter,
    pending: MotionDelta,
    pending_turn_rad: f64,
    lift: Lift,
    confidence: Confidence,
    lost: bool,
    /// The robot is lost because the map explains too little, and not because somebody lifted it.
    has_drifted: bool,
    weighings: u32,
    /// Ranges to beacons since the last weighing.
    ranges: Vec<LocatedRange>,
    /// Bias by zero-velocity updates since the last weighing.
    measured_bias: Option<BiasMeasurement>,
    standstill: Standstill,
    history: ScanHistory,
    /// While the robot is lost: the RSSI fingerprints.
    fingerprints: Option<Arc<FingerprintMap>>,
    /// Distance until the next global localization of a lost robot, metres.
    search_in_m: f64,
    /// The global localization in progress.
    global_localizer: Option<Box<GlobalLocalizer>>,
    /// Score of the map since the robot was found.
    since_found: BeamScore,
    /// Informative beams until a found pose is confirmed.
    unconfirmed: u32,
    /// It competes with other storeys, so contradictions of its map must not be explained away.
    competes: bool,
    dead_reckoning: DeadReckoning,
    lost_share: LostShare,
    /// What the map predicts beside what is met.
    map_check: MapCheck,
    radius_m: f64,
    layout: SensorLayout,
}

impl Tracker {
    /// A robot of this radius at the origin.
    pub(super) fn new(radius_m: f64, layout: SensorLayout, seed: u64) -> Self {
        Self {
            filter: ParticleFilter::new(radius_m, layout, seed),
            pending: MotionDelta::default(),
            pending_turn_rad: 0.0,
            lift: Lift::default(),
            confidence: Confidence::default(),
            lost: false,
            has_drifted: false,
            weighings: 0,
            ranges: Vec::new(),
            measured_bias: None,
            standstill: Standstill::default(),
            history: ScanHistory::default(),
            fingerprints: None,
            search_in_m: 0.0,
            global_localizer: None,
            since_found: BeamScore::default(),
            unconfirmed: 0,
            competes: false,
            dead_reckoning: DeadReckoning::default(),
            lost_share: LostShare::default(),
            map_check: MapCheck::default(),
            radius_m,
            layout,
        }
    }

    /// One of several, each in the map of another storey.
    pub(super) fn into_competitor(self) -> Self {
        Self {
            competes: true,
            ..self
        }
    }

    /// Estimate of the gyro.
    pub(super) fn gyro(&self) -> Option<GyroEstimate> {
        self.filter.gyro()
    }

    /// The robot is at `pose`, with these standard deviations.
    pub(super) fn place_at(&mut self, pose: Pose2, sigma_m: f64, sigma_rad: f64) {
        self.filter.gather(pose, PoseSpread { sigma_m, sigma_rad });
        self.forget_motion();
        self.confidence = Confidence::default();
        self.global_localizer = None;
        self.unconfirmed = 0;
        // A person who has placed it there does not carry it away.
        self.lift.settle();
        self.lost = false;
    }

    /// The robot is on its dock, whose place is known.
    pub(super) fn place_on_dock(&mut self, dock: Pose2, spread: PoseSpread) {
        self.place_at(dock, spread.sigma_m, spread.sigma_rad);
        self.dead_reckoning.begin_at(dock);
        self.lost_share.begin();
    }

    /// Only a person says where the robot is. Until so many informative beams have confirmed it, the pose must not lie in unknown
    /// space, and the filter learns nothing that a wrong pose would teach.
    pub(super) fn require_confirmation(&mut self, beams: u32) {
        self.unconfirmed = beams;
    }

    /// Whether the sensors clearly confirm the pose.
    pub(super) fn is_confirmed(&self) -> bool {
        !self.lost && self.unconfirmed == 0 && self.confidence.confirms()
    }

    /// Informative beams until the pose is confirmed.
    pub(super) fn unconfirmed_beams(&self) -> u32 {
        self.unconfirmed
    }

    /// The robot may be anywhere. Until global localization finds it, the particles stay around `pose`.
    pub(super) fn lose(&mut self, pose: Pose2) {
        self.filter.gather(pose, TRACKING.carried);
        self.forget_motion();
        self.confidence = Confidence::none();
        self.search_in_m = (SEARCH.from_m - self.history.length_m()).max(0.0);
        self.global_localizer = None;
        self.since_found = BeamScore::default();
        self.lost = true;
        self.has_drifted = false;
    }

    /// Whether too few sensors are compared with the map to tell a place in it.
    pub(super) fn is_blind(&self) -> bool {
        self.layout.proximity.sensors().len() < SENSORS_MIN
    }

    /// Whether the robot is lost.
    pub(super) fn is_lost(&self) -> bool {
        self.lost
    }

    /// Share of the sensor readings that the map explains, 0..1.
    pub(super) fn explained(&self) -> f64 {
        self.confidence.explained()
    }

    /// Why the map is doubted, and the share that speaks against it.
    pub(super) fn map_doubt(&self) -> Option<(MapDoubt, f64)> {
        let lost_share = || Some((MapDoubt::PlaceNotInMap, self.lost_share.doubt()?));
        self.map_check.doubt().or_else(lost_share)
    }

    /// Whether much of the map was met, and nothing made it doubtful.
    pub(super) fn has_map_held(&self) -> bool {
        self.map_check.has_met_much() && self.map_doubt().is_none()
    }

    /// Takes ranges to beacons whose positions are known.
    pub(super) fn add_ranges(&mut self, ranges: &[LocatedRange]) {
        self.ranges.extend_from_slice(ranges);
    }

    /// Takes signal strengths. They only restrict where a lost robot may be.
    pub(super) fn receive(&mut self, fingerprints: &RssiFingerprints) {
        self.history.receive(fingerprints.fresh());
        if !self.lost {
            self.fingerprints = None;
        } else if self.fingerprints.is_none() && !fingerprints.is_empty() {
            self.fingerprints = Some(fingerprints.map());
            let from_m = (SEARCH.rssi_from_m - self.history.length_m()).max(0.0);
            self.search_in_m = self.search_in_m.min(from_m);
        }
    }

    /// Whether the pose is known and confirmed.
    pub(super) fn is_settled(&self) -> bool {
        !self.lost && self.unconfirmed == 0 && !self.lift.is_in_air()
    }

    /// Does a step of the global localization of a lost robot, before each [`Self::follow`] or now and then.
    pub(super) fn step_search(&mut self, map: &impl Surroundings) {
        if let Some(search) = &mut self.global_localizer {
            search.go_on(map);
        }
    }

    /// Score of the map since the robot was found.
    pub(super) fn since_found(&self) -> BeamScore {
        self.since_found
    }

    /// A search for all poses that the last metres allow, whatever the estimate is.
    pub(super) fn second_look(&self, map: &impl Surroundings) -> Option<GlobalLocalizer> {
        GlobalLocalizer::of(&Whole(map), &self.history, self.radius_m)
    }

    /// Takes motion, observation and the pose by odometry. Returns the estimate after each weighing.
    pub(super) fn follow(
        &mut self,
        map: &impl Surroundings,
        observation: &Observation,
        moved: MotionUpdate,
    ) -> Option<PoseEstimate> {
        let MotionUpdate { advance, pose, .. } = moved;
        self.filter.set_gyro_prior(moved.gyro);
        self.collect(advance, moved.gyro);
        let measured = [self.measured_bias, moved.measured_bias];
        self.measured_bias = measured.into_iter().flatten().reduce(BiasMeasurement::and);
        if self.standstill.ends_long(advance) {
            self.filter.draw_bias(moved.gyro);
            self.measured_bias = None;
        }
        if let Some(search) = &mut self.global_localizer {
            search.follow(advance);
        }
        let Onsets {
            contacts,
            cliffs: edges,
            ..
        } = advance.onsets;
        self.lift.update(observation, advance);
        self.follow_since_dock(advance, moved.gyro);
        if self.lift.is_put_down() {
            self.put_down(pose);
            return Some(self.estimate());
        }
        self.history.sample(observation, &self.layout.proximity);
        self.history.touch(contacts, self.radius_m);
        let due = self.pending.distance_m >= TRACKING.weigh_m
            || self.pending_turn_rad >= TRACKING.weigh_rad
            || contacts.any()
            || edges.any();
        if !due || observation.wheel_drop {
            return None;
        }
        let mode = self.mode();
        let scale_sigma = match (advance.gyro_turn_rad, mode) {
            (None, _) => Some(ODOMETRY_NOISE.wheel_turn_scale),
            (Some(_), FilterMode::Searching) => Some(moved.gyro.scale_sigma),
            (Some(_), FilterMode::Holding) => None,
        };
        if let Some(scale_sigma) = scale_sigma {
            let scale_rad = TRACKING.correlated_scale * scale_sigma * self.pending_turn_rad;
            self.pending.turn_variance += scale_rad * scale_rad;
        }
        self.filter.set_mode(mode);
        self.filter.follow(self.pending);
        let ranges = core::mem::take(&mut self.ranges);
        let measurements = Measurements {
            contacts,
            edges,
            ranges: &ranges,
            measured_bias: self.measured_bias.take(),
        };
        self.forget_motion();
        self.weighings = self.weighings.saturating_add(1);
        let estimate = if self.lost {
            let map = &Whole(map);
            self.filter.weigh(map, observation, &measurements);
            self.search(map, pose)
        } else {
            self.filter.weigh(map, observation, &measurements);
            self.judge(map)
        };
        self.check_map(map, estimate.pose);
        Some(estimate)
    }

    fn follow_since_dock(&mut self, advance: Advance, gyro: GyroEstimate) {
        self.dead_reckoning.follow(advance, gyro);
        self.lost_share.follow(advance, self.lost);
    }

    /// Somebody has carried the robot elsewhere.
    fn put_down(&mut self, pose: Pose2) {
        self.dead_reckoning.end();
        self.lost_share.end();
        self.history.forget();
        self.lose(pose);
    }

    /// Compares what is met with the map, where the robot is by the particles, or by dead reckoning where that contradicts them or they
    /// do not know: a wrong map must not choose the place at which it is tested.
    fn check_map(&mut self, map: &impl Surroundings, by_particles: Pose2) {
        let is_settled = self.is_settled();
        let reckoned = self.dead_reckoning.pose().filter(|reckoned| {
            let apart_m = reckoned.position().distance_m(by_particles.position());
            !is_settled || apart_m > CONTRADICTION_M
        });
        let Some(pose) = reckoned.or(is_settled.then_some(by_particles)) else {
            return;
        };
        self.map_check.take(map, &self.filter.compared(map, pose));
    }

    /// Particles hold what they have learned only while the pose is known.
    fn mode(&self) -> FilterMode {
        let is_known = !self.lost && self.unconfirmed == 0 && !self.competes;
        if is_known && self.confidence.holds() {
            FilterMode::Holding
        } else {
            FilterMode::Searching
        }
    }

    /// Compares the estimate with the sensors, and draws the consequences.
    fn judge(&mut self, map: &impl Surroundings) -> PoseEstimate {
        let estimate = self.filter.estimate();
        let score = self.filter.score(map, estimate.pose);
        self.since_found = self.since_found.and(score);
        if self.unconfirmed > 0 {
            let score = self.filter.score(&Whole(map), estimate.pose);
            self.unconfirmed = self.unconfirmed.saturating_sub(score.informative);
            self.confidence.take(score);
        } else {
            self.confidence.take(score);
        }
        let verdict = self.confidence.verdict();
        // A vague position is not a wrong one: the particles hold the true one still, and the robot takes a fix at walls.
        if verdict == Verdict::Wrong {
            self.doubt(map, estimate.pose);
        } else {
            // The doubt is over, so a search that it started is obsolete.
            self.global_localizer = None;
            if verdict == Verdict::Doubtful && self.weighings > TRACKING.doubt_weighings {
                let doubt = if self.competes {
                    TRACKING.competitor_doubt
                } else {
                    TRACKING.doubt
                };
                self.filter.widen(estimate.pose, doubt);
                self.weighings = 0;
            }
        }
        PoseEstimate {
            lost: self.lost,
            ..estimate
        }
    }

    /// Searches for a robot that would be at `carried` by odometry.
    fn search(&mut self, map: &impl Surroundings, carried: Pose2) -> PoseEstimate {
        let (estimate, share) = self.filter.cluster();
        self.confidence.take(self.filter.score(map, estimate.pose));
        let gathered = share >= TRACKING.found_share && estimate.sigma_m <= TRACKING.found_sigma_m;
        if self.global_localizer.is_none() && self.search_in_m <= 0.0 {
            self.search_in_m = match self.fingerprints {
                Some(_) => SEARCH.rssi_every_m,
                None => SEARCH.every_m,
            };
            let matcher = self.fingerprints.clone();
            let matcher = matcher.map(|map| FingerprintMatcher::new(self.history.received(), map));
            self.global_localizer = GlobalLocalizer::of(map, &self.history, self.radius_m)
                .map(|search| Box::new(search.with_rssi(matcher)));
        }
        if let Some(candidates) = self
            .global_localizer
            .as_ref()
            .and_then(|search| search.candidates())
        {
            self.global_localizer = None;
            let candidates = if self.has_drifted {
                near_if_as_good(candidates, carried)
            } else {
                candidates
            };
            if gathered && self.confidence.is_found() && is_alone(&candidates, estimate.pose) {
                self.lost = false;
                self.weighings = 0;
                self.unconfirmed = CONFIRMATION_BEAMS;
            } else if !gathered || !is_among(&candidates, estimate.pose) {
                self.scatter_around(&candidates);
            }
        }
        PoseEstimate {
            lost: self.lost,
            ..estimate
        }
    }

    fn scatter_around(&mut self, candidates: &[PoseCandidate]) {
        if candidates.is_empty() {
            return;
        }
        let poses: Vec<Pose2> = candidates.iter().map(|candidate| candidate.pose).collect();
        self.filter.scatter(&poses, TRACKING.candidate);
        self.confidence = Confidence::none();
    }

    pub(super) fn estimate(&self) -> PoseEstimate {
        PoseEstimate {
            lost: self.lost,
            ..self.filter.estimate()
        }
    }

    fn collect(&mut self, advance: Advance, gyro: GyroEstimate) {
        self.pending.gyro.add(advance, gyro);
        self.pending.step = self.pending.step.after_arc(advance.distance_m, advance.turn_rad);
        self.pending.distance_m += advance.distance_m.abs();
        self.pending.turn_variance += turn_variance(advance);
        self.pending_turn_rad += advance.turn_rad.abs();
        self.history.advance(advance);
        self.search_in_m -= advance.distance_m.abs();
    }

    fn forget_motion(&mut self) {
        self.ranges.clear();
        self.pending = MotionDelta::default();
        self.pending_turn_rad = 0.0;
    }
}
