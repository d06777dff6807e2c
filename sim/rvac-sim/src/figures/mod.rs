//! Figures of navigation: how fast a run covers the floor compared with the lower bound, and how accurate the pose is.
//!
//! *Job*: begins when the host reports that it cleans, and lasts until it reports another state (docking, docked, idle, stuck)
//! or until the run's end. A pause belongs to it. All figures of time, turning and bumps are of the job; those of the
//! pose are of the whole run, because the robot needs its pose to return home too.

mod alignment;
mod field;
mod honesty;
mod lost;
mod nees;
mod pose_error;
mod time_spent;

use brain::{BehaviorState, SweptShare};
use home::{Pose, Truth};
use serde::Serialize;

use crate::map_obstacles::MapObstacles;
use alignment::Alignment;
use field::FieldWatch;
pub use field::{FieldMeasures, field_line};
use honesty::HonestyWatch;
pub use lost::LostStretch;
use lost::LostWatch;
use nees::NeesWatch;
pub(crate) use nees::Sigma;
use pose_error::PoseError;
pub use time_spent::TimeSpent;
use time_spent::TimeWatch;

/// Shares of the reachable floor whose moments are noted.
const SHARES: [f64; 3] = [0.80, 0.90, 0.95];
/// Multiples of T0 at which the covered share is noted.
const MULTIPLES: [f64; 2] = [1.0, 1.8];

/// A robot that came so far left the place where it began.
const AWAY_M: f64 = 1.0;

/// The figures, as the report has them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Figures {
    /// Time until 80 % were swept over the lower bound; `null` = not reached.
    pub t80_over_t0: Option<f64>,
    /// The same for 90 %.
    pub t90_over_t0: Option<f64>,
    /// The same for 95 %.
    pub t95_over_t0: Option<f64>,
    /// Share that was swept after T0; `null` = the run was shorter.
    pub share_at_t0: Option<f64>,
    /// Share that was swept after 1.8 T0.
    pub share_at_1_8_t0: Option<f64>,
    /// Swept share that the host reported in the last minute of its job; `null` = none.
    #[serde(rename = "share_told")]
    pub reported_share: Option<f64>,
    /// Lower bound of that share.
    #[serde(rename = "share_told_low")]
    pub reported_share_low: Option<f64>,
    /// Largest excess of that lower bound over the true share in any minute; below 0 if there was none.
    #[serde(rename = "told_low_over_true")]
    pub reported_low_over_true: Option<f64>,
    /// The swept share that the host reported last in its job, minus the true one at that moment.
    pub told_minus_true: Option<f64>,
    /// Measures that the field reports.
    pub field: FieldMeasures,
    /// Length of the job over the lower bound; `null` = it was not over.
    pub job_over_t0: Option<f64>,
    /// Seconds of the job until the robot was a metre away from where it began: how long a trap held it; `null` = it
    /// never was.
    pub away_s: Option<f64>,
    /// Seconds on the charger in the middle of the job; no other figure counts them.
    pub charging_s: f64,
    /// What the job's seconds were spent on.
    pub time_spent: TimeSpent,
    /// Turning during the job for each square metre of reachable floor, degrees.
    pub turn_deg_per_m2: f64,
    /// Contacts during the job for each square metre of reachable floor.
    pub bumps_per_m2: f64,
    /// Root mean square of the distance between believed and true place in the two minutes before this minute of the
    /// job; `null` = the run was shorter.
    pub pose_rmse_10_min_m: Option<f64>,
    /// The same at 30 minutes.
    pub pose_rmse_30_min_m: Option<f64>,
    /// The same at 60 minutes.
    pub pose_rmse_60_min_m: Option<f64>,
    /// The same at 120 minutes.
    pub pose_rmse_120_min_m: Option<f64>,
    /// Root mean square of the distance after rigid alignment of the estimated path with the true one.
    pub pose_rmse_aligned_m: Option<f64>,
    /// Largest distance between believed and true place.
    pub pose_error_max_m: f64,
    /// The same after rigid alignment of the estimated path with the true one.
    pub pose_error_max_aligned_m: f64,
    /// Median distance between believed and true place, and the 90th percentile.
    pub pose_error_median_m: Option<f64>,
    /// See [`Self::pose_error_median_m`].
    pub pose_error_p90_m: Option<f64>,
    /// The same after rigid alignment of the estimated path with the true one.
    pub pose_error_median_aligned_m: Option<f64>,
    /// See [`Self::pose_error_median_aligned_m`].
    pub pose_error_p90_aligned_m: Option<f64>,
    /// Median of the standard deviation of its position that the robot reports.
    pub sigma_median_m: Option<f64>,
    /// Mean of the position's error squared over its reported variance, for each dimension, while the robot is off its dock and does
    /// not say that it is lost: 1 when the reported deviation is true, more when it is too small.
    pub nees_place: Option<f64>,
    /// The same after rigid alignment of the estimated path with the true one.
    pub nees_place_aligned: Option<f64>,
    /// The median of the same, over the median for true deviations, so that moments with a deviation near zero do not count for all.
    pub nees_place_median_aligned: Option<f64>,
    /// The same of the heading.
    pub nees_heading: Option<f64>,
    /// Root mean square of the error of the heading, degrees.
    pub heading_rmse_deg: Option<f64>,
    /// Seconds in periods of more than a minute with a pose error of more than half a metre.
    pub lost_seconds: f64,
    /// How often that happened.
    pub lost_times: u32,
    /// Each of these periods.
    pub lost_stretches: Vec<LostStretch>,
    /// Seconds with the place wrong by more than half a metre of which the robot did not say that it is lost.
    pub lost_unnoticed_s: f64,
    /// The same after rigid alignment of the estimated path with the true one.
    pub lost_unnoticed_aligned_s: f64,
    /// Seconds in which the robot said that it is lost, and its place was right within half a metre.
    pub lost_false_alarm_s: f64,
    /// Agreement of the robot's free floor with the true one, 0..1 (intersection over union with the reachable floor).
    /// `null` = it has no map.
    pub map_iou: Option<f64>,
    /// The same when the map is laid over the home as a whole, as its walls fit best.
    pub map_iou_aligned: Option<f64>,
    /// Mean distance of the walls of its map from true ones, metres.
    pub wall_error_m: Option<f64>,
    /// The same when the map is laid over the home as a whole.
    pub wall_error_aligned_m: Option<f64>,
    /// Obstacles of the map that do not exist, and those that it lacks.
    pub map_obstacles: Option<MapObstacles>,
    /// Share of the rug floor under the swath that the robot's map has as carpet; `null` = the swath was on no rug, or
    /// the robot does not measure what its motors draw.
    pub carpet_recall: Option<f64>,
    /// Share of the carpet in its map that lies on a rug; `null` = it has none.
    pub carpet_precision: Option<f64>,
    /// Swept area by the robot's estimate minus the true one, over the reachable area.
    pub estimate_error: Option<f64>,
    /// The robot was on its dock at the end.
    pub docked: bool,
    /// Last state that the host reported.
    pub state: String,
}

/// What the host says in a moment, in the map frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Belief {
    pub(crate) pose: Pose,
    pub(crate) state: Option<BehaviorState>,
    pub(crate) lost: bool,
    /// The uncertainty that it reports.
    pub(crate) sigma: Sigma,
    /// The job goes on once the pack is charged.
    pub(crate) awaits_charge: bool,
}

/// What the figures are of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeasuredFloor {
    pub(crate) reachable_m2: f64,
    pub(crate) t0_s: f64,
    /// Speed at which the robot cleans.
    pub(crate) cruise_m_per_s: f64,
    /// Rooms of the plan, if it knows any.
    pub(crate) rooms: Option<u32>,
}

impl MeasuredFloor {
    /// Width of the swath.
    pub(crate) fn swath_m(&self) -> f64 {
        self.reachable_m2 / (self.t0_s * self.cruise_m_per_s)
    }
}

/// Collects the data of the figures.
#[derive(Clone, Debug)]
pub(crate) struct Collector {
    floor: MeasuredFloor,
    job: JobFigures,
    reached_s: [Option<f64>; SHARES.len()],
    share_at: [Option<f64>; MULTIPLES.len()],
    begun_at: Option<Pose>,
    away_s: Option<f64>,
    turn_rad: f64,
    heading_rad: Option<f64>,
    contacts_before: u32,
    contacts: u32,
    pose_error: PoseError,
    lost: LostWatch,
    honesty: HonestyWatch,
    nees: NeesWatch,
    field: FieldWatch,
    alignment: Alignment,
    time: TimeWatch,
    reported: ReportedShare,
    last: Option<BehaviorState>,
    docked: bool,
}

/// The swept share as the host reports it.
#[derive(Clone, Copy, Debug, Default)]
struct ReportedShare {
    last: Option<SweptShare>,
    minus_true: Option<f64>,
    low_over_true: Option<f64>,
}

#[derive(Clone, Copy, Debug, Default)]
struct JobFigures {
    begun_ms: Option<u64>,
    ended_ms: Option<u64>,
    /// Time on the charger in the middle of the job.
    charging_ms: u64,
    last_ms: Option<u64>,
    charges: bool,
}

impl JobFigures {
    fn follow(&mut self, now_ms: u64, belief: &Belief) {
        use BehaviorState::{Cleaning, Docked, Docking, Error, Idle, Spot, Stuck};
        let passed_ms = now_ms - self.last_ms.replace(now_ms).unwrap_or(now_ms);
        self.charges = belief.awaits_charge && belief.state == Some(Docked);
        // A job that is ordered at an empty battery waits before it begins: that takes nothing from its own time.
        if self.charges && self.begun_ms.is_some() {
            self.charging_ms += passed_ms;
        }
        match belief.state {
            Some(Cleaning | Spot) => {
                self.begun_ms.get_or_insert(now_ms);
                self.ended_ms = None;
            }
            Some(Docking | Docked | Idle | Stuck | Error)
                if self.begun_ms.is_some() && !belief.awaits_charge =>
            {
                self.ended_ms.get_or_insert(now_ms);
            }
            _ => {}
        }
    }

    /// It is running; on the charger it is not.
    fn runs(self) -> bool {
        self.begun_ms.is_some() && self.ended_ms.is_none() && !self.charges
    }

    /// Nothing more is swept by it for now.
    fn rests(self) -> bool {
        self.ended_ms.is_some() || self.charges
    }
}

impl Collector {
    pub(crate) fn new(floor: MeasuredFloor) -> Self {
        Self {
            floor,
            job: JobFigures::default(),
            reached_s: [None; SHARES.len()],
            share_at: [None; MULTIPLES.len()],
            begun_at: None,
            away_s: None,
            turn_rad: 0.0,
            heading_rad: None,
            contacts_before: 0,
            contacts: 0,
            pose_error: PoseError::default(),
            lost: LostWatch::default(),
            honesty: HonestyWatch::default(),
            nees: NeesWatch::default(),
            field: FieldWatch::default(),
            alignment: Alignment::default(),
            time: TimeWatch::new(&floor),
            reported: ReportedShare::default(),
            last: None,
            docked: false,
        }
    }

    /// One sample. `truth_in_map` is the true pose in the map frame.
    pub(crate) fn sample(&mut self, truth: &Truth, truth_in_map: Pose, belief: &Belief) {
        let now_ms = truth.time_ms;
        self.job.follow(now_ms, belief);
        self.last = belief.state;
        self.docked = truth.docked;
        let turned_rad = self
            .heading_rad
            .replace(truth.pose.heading_rad)
            .map_or(0.0, |before| (truth.pose.heading_rad - before).abs());
        let bumped = truth.contacts - self.contacts_before;
        self.contacts_before = truth.contacts;
        let job_s = self.job_s(now_ms);
        if self.job.runs() {
            self.turn_rad += turned_rad;
            self.contacts += bumped;
            self.note_share(job_s, truth.swept_share);
            self.field.sample(truth, &self.floor);
            let begun_at = *self.begun_at.get_or_insert(truth.pose);
            if begun_at.distance_m(truth.pose) >= AWAY_M {
                self.away_s.get_or_insert(job_s);
            }
        }
        self.time.sample(truth, self.job.runs());
        if !self.job.charges {
            self.sample_place((job_s, now_ms - self.job.charging_ms), truth_in_map, belief);
        }
    }

    /// Hours on the dock would make the position error look small, and are left out.
    fn sample_place(&mut self, (job_s, work_ms): (f64, u64), truth_in_map: Pose, belief: &Belief) {
        let error_m = belief.pose.distance_m(truth_in_map);
        let error_rad = home::wrap_angle(belief.pose.heading_rad - truth_in_map.heading_rad);
        self.pose_error.sample(job_s, error_m, error_rad);
        self.alignment
            .sample((work_ms, self.docked), belief, truth_in_map);
        if !belief.lost && !self.docked {
            self.nees.sample(error_m, error_rad, belief.sigma);
        }
        self.lost.sample(work_ms, error_m);
        self.honesty.sample(work_ms, error_m, belief.lost);
    }

    /// The host has just said how much it has swept; `swept_share` is the truth.
    pub(crate) fn note_reported(&mut self, reported: Option<SweptShare>, swept_share: f64) {
        let Some(share) = reported else { return };
        let over = share.share_low - swept_share;
        self.reported.last = reported;
        self.reported.minus_true = Some(share.share - swept_share);
        self.reported.low_over_true = Some(
            self.reported
                .low_over_true
                .map_or(over, |before| before.max(over)),
        );
    }

    /// Seconds since the job began, without those on the charger.
    pub(crate) fn job_s(&self, now_ms: u64) -> f64 {
        let begun_ms = self.job.begun_ms.unwrap_or(now_ms);
        (now_ms - begun_ms - self.job.charging_ms) as f64 / 1000.0
    }

    /// Time that the robot spent on the charger in the middle of its job.
    pub(crate) fn charging_ms(&self) -> u64 {
        self.job.charging_ms
    }

    fn note_share(&mut self, job_s: f64, share: f64) {
        for (reached_s, wanted) in self.reached_s.iter_mut().zip(SHARES) {
            if share >= wanted {
                reached_s.get_or_insert(job_s);
            }
        }
        for (noted, multiple) in self.share_at.iter_mut().zip(MULTIPLES) {
            if job_s >= multiple * self.floor.t0_s {
                noted.get_or_insert(share);
            }
        }
    }

    /// The share swept `multiple` x T0 after the job began; a job that was over earlier has what it had at its end, and
    /// one that waits for charge what it has now.
    fn share_at(&self, number: usize, now: &Truth) -> Option<f64> {
        let rests = self.job.rests();
        self.share_at[number].or(rests.then_some(now.swept_share))
    }

    /// The figures up to now.
    pub(crate) fn figures(&self, now: &Truth) -> Figures {
        let t0_s = self.floor.t0_s;
        let [t80, t90, t95] = self.reached_s.map(|reached| reached.map(|s| s / t0_s));
        let per_m2 = |value: f64| value / self.floor.reachable_m2;
        let [at_10, at_30, at_60, at_120] = self.pose_error.at_marks();
        let left_over = self.alignment.left_over();
        let placed = self.alignment.placed();
        let nees = self.nees.means();
        let job_s = self.job.ended_ms.map(|ended_ms| self.job_s(ended_ms));
        let contacts = (self.contacts, job_s);
        let lost_stretches = self.lost.stretches();
        Figures {
            t80_over_t0: t80,
            t90_over_t0: t90,
            t95_over_t0: t95,
            share_at_t0: self.share_at(0, now),
            share_at_1_8_t0: self.share_at(1, now),
            reported_share: self.reported.last.map(|reported| reported.share),
            reported_share_low: self.reported.last.map(|reported| reported.share_low),
            reported_low_over_true: self.reported.low_over_true,
            told_minus_true: self.reported.minus_true,
            field: self.field.measures(now.swept_share, contacts, &self.floor),
            job_over_t0: job_s.map(|job_s| job_s / t0_s),
            charging_s: self.job.charging_ms as f64 / 1000.0,
            away_s: self.away_s,
            time_spent: self.time.spent(),
            turn_deg_per_m2: per_m2(self.turn_rad.to_degrees()),
            bumps_per_m2: per_m2(f64::from(self.contacts)),
            pose_rmse_10_min_m: at_10,
            pose_rmse_30_min_m: at_30,
            pose_rmse_60_min_m: at_60,
            pose_rmse_120_min_m: at_120,
            pose_rmse_aligned_m: self.alignment.rmse_m(),
            pose_error_max_m: self.pose_error.max_m(),
            pose_error_max_aligned_m: left_over.max_m,
            pose_error_median_m: placed.map(|placed| placed.median),
            pose_error_p90_m: placed.map(|placed| placed.p90),
            pose_error_median_aligned_m: left_over.error.map(|error| error.median),
            pose_error_p90_aligned_m: left_over.error.map(|error| error.p90),
            sigma_median_m: self.alignment.sigma_median_m(),
            nees_place: nees.map(|(place, _)| place),
            nees_place_aligned: left_over.nees,
            nees_place_median_aligned: left_over.nees_median,
            nees_heading: nees.map(|(_, heading)| heading),
            heading_rmse_deg: self.pose_error.heading_rmse_rad().map(f64::to_degrees),
            lost_seconds: lost_stretches
                .iter()
                .fold(0.0, |sum_s, stretch| sum_s + stretch.length_s),
            lost_times: lost_stretches.len() as u32,
            lost_stretches,
            lost_unnoticed_s: self.honesty.unnoticed_s(),
            lost_unnoticed_aligned_s: left_over.unnoticed_s,
            lost_false_alarm_s: self.honesty.false_alarm_s(),
            map_iou: None,
            map_iou_aligned: None,
            wall_error_m: None,
            wall_error_aligned_m: None,
            map_obstacles: None,
            carpet_recall: None,
            carpet_precision: None,
            estimate_error: None,
            docked: self.docked,
            state: self
                .last
                .map_or_else(String::new, |state| state.name().to_owned()),
        }
    }

    /// The job began and is over.
    pub(crate) fn job_is_over(&self) -> bool {
        self.job.ended_ms.is_some()
    }

    /// 95 % were swept.
    pub(crate) fn reached_all_shares(&self) -> bool {
        self.reached_s.iter().all(Option::is_some)
    }

    /// Root mean square of the distance between believed and true place over the whole run.
    pub(crate) fn pose_rmse_m(&self) -> Option<f64> {
        self.pose_error.rmse_m()
    }
}

#[cfg(test)]
mod tests {
    use super::{Belief, Collector, MeasuredFloor, Sigma};
    use brain::BehaviorState;
    use home::{Home, Noise, Pose, RobotModel, Truth, World};
    use std::sync::Arc;

    const PLAN: &str =
        "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0, 0], [2, 0], [2, 2], [0, 2]]\n";

    fn truth() -> Truth {
        let model = RobotModel::by_name("sr8730").unwrap();
        let home = Home::from_floorplan("room", PLAN, &model).unwrap();
        *World::new(Arc::new(home), &model, &Noise::ideal(), 1, None).truth()
    }

    fn collector() -> Collector {
        Collector::new(MeasuredFloor {
            reachable_m2: 2.0,
            t0_s: 10.0,
            cruise_m_per_s: 0.25,
            rooms: None,
        })
    }

    fn belief(state: BehaviorState) -> Belief {
        Belief {
            pose: Pose::default(),
            state: Some(state),
            lost: false,
            sigma: Sigma::default(),
            awaits_charge: false,
        }
    }

    #[test]
    fn times_count_from_the_beginning_of_cleaning_and_end_with_it() {
        let mut collector = collector();
        let mut truth = truth();
        let states = [
            (0, BehaviorState::Starting, 0.0),
            (3_000, BehaviorState::Cleaning, 0.0),
            (15_000, BehaviorState::Cleaning, 0.82),
            (18_000, BehaviorState::Cleaning, 0.91),
            (20_000, BehaviorState::Docking, 0.92),
            (40_000, BehaviorState::Docked, 0.96),
        ];
        for (time_ms, state, share) in states {
            (truth.time_ms, truth.swept_share) = (time_ms, share);
            truth.pose.heading_rad += 1.0;
            truth.contacts += 1;
            collector.sample(&truth, Pose::default(), &belief(state));
        }
        let figures = collector.figures(&truth);
        assert_eq!(figures.t80_over_t0, Some(1.2));
        assert_eq!(figures.t90_over_t0, Some(1.5));
        assert_eq!(
            figures.t95_over_t0, None,
            "what the way home sweeps is no cleaning"
        );
        assert_eq!(figures.share_at_t0, Some(0.82));
        assert_eq!(figures.job_over_t0, Some(1.7));
        assert!((figures.turn_deg_per_m2 - 1.5_f64.to_degrees()).abs() < 1e-9);
        assert_eq!(figures.bumps_per_m2, 1.5);
        assert_eq!(figures.state, "docked");
    }

    #[test]
    fn a_job_goes_on_after_a_charge_and_its_time_is_without_it() {
        let mut collector = collector();
        let mut truth = truth();
        let states = [
            (0, BehaviorState::Cleaning, false, 0.0),
            (8_000, BehaviorState::Cleaning, false, 0.81),
            (9_000, BehaviorState::Docking, true, 0.82),
            (11_000, BehaviorState::Docked, true, 0.82),
            (7_211_000, BehaviorState::Docked, true, 0.82),
            (7_212_000, BehaviorState::Cleaning, false, 0.82),
            (7_216_000, BehaviorState::Cleaning, false, 0.96),
            (7_220_000, BehaviorState::Docking, false, 0.97),
        ];
        for (time_ms, state, awaits_charge, share) in states {
            (truth.time_ms, truth.swept_share) = (time_ms, share);
            let belief = Belief {
                awaits_charge,
                ..belief(state)
            };
            collector.sample(&truth, Pose::default(), &belief);
            assert_eq!(
                collector.job_is_over(),
                time_ms == 7_220_000,
                "a job that waits for charge is not over"
            );
        }
        let figures = collector.figures(&truth);
        assert_eq!(figures.t80_over_t0, Some(0.8));
        assert_eq!(
            figures.t90_over_t0,
            Some(1.4),
            "two hours on the charger are no work"
        );
        assert_eq!(figures.charging_s, 7_202.0);
        assert_eq!(figures.job_over_t0, Some(1.8));
    }

    #[test]
    fn what_is_charged_before_the_job_begins_takes_nothing_from_it() {
        let mut collector = collector();
        let mut truth = truth();
        let states = [
            (0, BehaviorState::Docked, true),
            (3_600_000, BehaviorState::Docked, true),
            (3_601_000, BehaviorState::Cleaning, false),
            (3_605_000, BehaviorState::Docking, false),
        ];
        for (time_ms, state, awaits_charge) in states {
            truth.time_ms = time_ms;
            let belief = Belief {
                awaits_charge,
                ..belief(state)
            };
            collector.sample(&truth, Pose::default(), &belief);
        }
        let figures = collector.figures(&truth);
        assert_eq!(figures.charging_s, 0.0);
        assert_eq!(figures.job_over_t0, Some(0.4));
    }
}
