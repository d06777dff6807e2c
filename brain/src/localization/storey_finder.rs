//! Finds out on which of several storeys the robot is, by comparing the map of each with what the robot observes.
//!
//! *Hypothesis*: a storey whose map may be the right one. The robot is lost in it and localizes globally ([`super::tracker`]). A
//! hypothesis that has found a pose must explain the observations of the further path, which a wrong one does not. After some
//! metres it is checked once more (*second look*): the last metres are matched against all positions in the maps of all hypotheses.
//! The hypothesis wins when they match at its pose, and nowhere else nearly as well. Two storeys that are alike never win. Then a
//! person must choose.

use core::task::Poll;

use super::TrackingCheckpoint;
use super::candidates::is_far_ahead;
use super::global_localizer::{GlobalLocalizer, PoseCandidate};
use super::odometry::Odometry;
use super::reference_map::ReferenceMap;
use super::tracker::{MotionUpdate, SENSORS_MIN, Tracker};
use crate::mapping::StoredMap;
use crate::model::advance::Advance;
use crate::model::config::BrainConfig;
use crate::model::geometry::Pose2;
use crate::model::gradual::{Gradual, StepBudget};
use crate::model::observation::Observation;
use crate::model::onsets::OnsetDetector;

/// When a storey counts as found. A hypothesis is one storey's map with the robot in it.
struct FinderParameters {
    /// Distance for which a hypothesis must explain the observations, metres.
    proven_m: f64,
    /// Informative beams that it needs over this distance.
    proven_beams_min: u32,
    /// Share of these that must be consistent with its map.
    proven_share_min: f64,
    /// The last metres must match the winner's map with this score.
    winner_score_min: f64,
    /// They may match other places, on this storey and the others, with at most this share of it.
    others_share_max: f64,
    /// Distance after an inconclusive second look until the next one, metres.
    look_again_m: f64,
    /// After this distance without a winner the robot asks a person and continues to search, metres.
    ask_after_m: f64,
    /// After this distance it gives up, metres.
    give_up_m: f64,
}

const PARAMETERS: FinderParameters = FinderParameters {
    proven_m: 6.0,
    proven_beams_min: 150,
    proven_share_min: 0.8,
    winner_score_min: 0.6,
    others_share_max: 0.85,
    look_again_m: 6.0,
    ask_after_m: 40.0,
    give_up_m: 120.0,
};

/// Result of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StoreyFinding {
    /// No result yet.
    Open,
    /// The robot is there.
    Found(StoreyPose),
    /// No result after so much driving that a person should be asked. A storey may still be found.
    Unclear,
}

/// A pose on one of the storeys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoreyPose {
    /// Number of the storey.
    pub floor: u16,
    /// Pose of the robot in the storey's map.
    pub pose: Pose2,
    /// Uncertainty of the pose, and what was learned of the gyro meanwhile.
    pub tracking: TrackingCheckpoint,
}

/// The search for the storey.
#[derive(Debug)]
pub struct StoreyFinder {
    odometry: Odometry,
    onsets: OnsetDetector,
    config: BrainConfig,
    seed: u64,
    /// Storeys whose maps are still loading, the last one first.
    loading: Vec<(u16, Gradual<ReferenceMap>)>,
    hypotheses: Vec<StoreyHypothesis>,
    /// Index of the hypothesis that searches in the next step. One searches per step, so steps take the same time with many
    /// storeys.
    next_search: usize,
    distance_m: f64,
    /// Searches of the second look, one for each hypothesis in order.
    second_look: Option<Vec<GlobalLocalizer>>,
    looks_from_m: f64,
    /// The hypothesis that has won. Loading its map takes the caller some steps.
    winner: Option<usize>,
    can_see: bool,
}

#[derive(Clone, Debug)]
struct StoreyHypothesis {
    floor: u16,
    tracker: Tracker,
    reference_map: ReferenceMap,
    /// Distance since it found the robot, metres.
    proven_m: f64,
    /// Second looks since then that were not clear, less those that were.
    unclear_looks: u32,
}

impl StoreyFinder {
    /// For a robot that may be anywhere on these storeys. Equal seeds and observations give equal results.
    #[must_use]
    pub fn new<'home>(
        config: &BrainConfig,
        seed: u64,
        floors: impl Iterator<Item = (u16, &'home StoredMap)>,
    ) -> Self {
        let rim_max_m_per_s =
            config.speeds.max_m_per_s + 0.5 * config.body.track_m * config.speeds.turn_max_rad_per_s;
        let ready = |(floor, home): (u16, &StoredMap)| {
            let home = home.clone();
            let reference_map =
                async move { ReferenceMap::of_stored(home, &mut StepBudget::limited()).await };
            (floor, Gradual::new(reference_map))
        };
        Self {
            odometry: Odometry::new(config.body.track_m, rim_max_m_per_s),
            onsets: OnsetDetector::default(),
            config: *config,
            seed,
            loading: floors.map(ready).collect(),
            hypotheses: Vec::new(),
            next_search: 0,
            distance_m: 0.0,
            second_look: None,
            looks_from_m: 0.0,
            winner: None,
            can_see: config.sensors.proximity.sensors().len() >= SENSORS_MIN,
        }
    }

    /// Takes an observation.
    pub fn follow(&mut self, observation: &Observation) -> StoreyFinding {
        let advance = Advance {
            onsets: self.onsets.take(observation),
            ..self.odometry.update(observation)
        };
        if !self.can_see || self.distance_m > PARAMETERS.give_up_m {
            return StoreyFinding::Unclear;
        }
        self.load_maps();
        if observation.wheel_drop || !self.loading.is_empty() {
            (self.distance_m, self.looks_from_m) = (0.0, 0.0);
        }
        self.distance_m += advance.distance_m.abs();
        let moved = self.moved(advance);
        for hypothesis in &mut self.hypotheses {
            hypothesis.follow(observation, moved);
        }
        match self.judge(advance) {
            Some(place) => StoreyFinding::Found(place),
            None if self.distance_m > PARAMETERS.ask_after_m => StoreyFinding::Unclear,
            None => StoreyFinding::Open,
        }
    }

    /// Continues the second look, or the searches of the hypotheses until one is proven.
    fn judge(&mut self, advance: Advance) -> Option<StoreyPose> {
        let winner = self.winner.and_then(|winner| self.hypotheses.get(winner));
        if let Some(winner) = winner.filter(|winner| winner.is_proven()) {
            return Some(self.place_on(winner));
        }
        self.winner = None;
        let proven = self.hypotheses.iter().position(StoreyHypothesis::is_proven);
        let Some(proven) = proven.filter(|_| self.loading.is_empty() && self.distance_m >= self.looks_from_m)
        else {
            self.second_look = None;
            self.step_search();
            return None;
        };
        let Some(looks) = &mut self.second_look else {
            let looks = self.hypotheses.iter().map(StoreyHypothesis::second_look);
            self.second_look = looks.collect();
            return None;
        };
        looks.iter_mut().for_each(|look| look.follow(advance));
        let undone = self.hypotheses.iter().zip(looks.iter_mut());
        if let Some((hypothesis, look)) = undone.into_iter().find(|(_, look)| look.candidates().is_none()) {
            look.go_on(&hypothesis.reference_map);
            return None;
        }
        let all: Vec<Vec<PoseCandidate>> = looks.iter().filter_map(GlobalLocalizer::candidates).collect();
        self.second_look = None;
        self.looks_from_m = self.distance_m + PARAMETERS.look_again_m;
        let proven_one = self.hypotheses.get_mut(proven)?;
        let is_sure = proven_one.is_sure_after(is_clear(&all, proven, proven_one.tracker.estimate().pose));
        self.winner = is_sure.then_some(proven);
        let winner = self.hypotheses.get(self.winner?)?;
        Some(self.place_on(winner))
    }

    fn step_search(&mut self) {
        if let Some(hypothesis) = self.hypotheses.get_mut(self.next_search) {
            hypothesis.tracker.step_search(&hypothesis.reference_map);
        }
        self.next_search = (self.next_search + 1) % self.hypotheses.len().max(1);
    }

    /// Does one step of loading the maps.
    fn load_maps(&mut self) {
        let Some((floor, reference_map)) = self.loading.last_mut() else {
            return;
        };
        if let Poll::Ready(reference_map) = reference_map.go_on() {
            let mut tracker =
                Tracker::new(self.config.body.radius_m, self.config.sensors, self.seed).into_competitor();
            tracker.lose(Pose2::IDENTITY);
            self.hypotheses.push(StoreyHypothesis {
                floor: *floor,
                tracker,
                reference_map,
                proven_m: 0.0,
                unclear_looks: 0,
            });
            self.loading.pop();
        }
    }

    fn moved(&self, advance: Advance) -> MotionUpdate {
        MotionUpdate::of(&self.odometry, advance, self.odometry.odom_from_base())
    }

    fn place_on(&self, hypothesis: &StoreyHypothesis) -> StoreyPose {
        let estimate = hypothesis.tracker.estimate();
        let (gyro_scale, gyro_bias_rad_per_s) = self.odometry.gyro();
        StoreyPose {
            floor: hypothesis.floor,
            pose: estimate.pose,
            tracking: TrackingCheckpoint {
                sigma_m: estimate.sigma_m,
                sigma_rad: estimate.sigma_rad,
                lost: false,
                gyro_scale,
                gyro_bias_rad_per_s,
                unconfirmed_beams: 0,
            },
        }
    }
}

impl StoreyHypothesis {
    fn follow(&mut self, observation: &Observation, moved: MotionUpdate) {
        self.tracker.follow(&self.reference_map, observation, moved);
        if self.tracker.is_lost() {
            (self.proven_m, self.unclear_looks) = (0.0, 0);
        } else {
            self.proven_m += moved.advance.distance_m.abs();
        }
    }

    /// Takes a second look. Whoever looks often enough sees what he wants to see once, so each look that was not clear must be made up
    /// for by a clear one.
    fn is_sure_after(&mut self, is_clear: bool) -> bool {
        if !is_clear {
            self.unclear_looks = self.unclear_looks.saturating_add(1);
            return false;
        }
        let is_sure = self.unclear_looks == 0;
        self.unclear_looks = self.unclear_looks.saturating_sub(1);
        is_sure
    }

    fn is_proven(&self) -> bool {
        let score = self.tracker.since_found();
        self.proven_m >= PARAMETERS.proven_m
            && score.informative >= PARAMETERS.proven_beams_min
            && f64::from(score.consistent) >= PARAMETERS.proven_share_min * f64::from(score.informative)
    }

    fn second_look(&self) -> Option<GlobalLocalizer> {
        self.tracker.second_look(&self.reference_map)
    }
}

/// Whether the candidates on storey `winner` confirm `pose`, and those on the others score clearly lower.
fn is_clear(all: &[Vec<PoseCandidate>], winner: usize, pose: Pose2) -> bool {
    let best = |candidates: &[PoseCandidate]| candidates.first().map_or(0.0, |best| best.score);
    let Some(own) = all.get(winner) else {
        return false;
    };
    let others = all.iter().enumerate().filter(|(place, _)| *place != winner);
    is_far_ahead(own, pose, PARAMETERS.others_share_max)
        && best(own) >= PARAMETERS.winner_score_min
        && others
            .into_iter()
            .all(|(_, candidates)| best(candidates) <= PARAMETERS.others_share_max * best(own))
}
