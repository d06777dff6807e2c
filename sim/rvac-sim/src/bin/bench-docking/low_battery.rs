//! Jobs that one charge is not enough for: home, charged, and on where they stopped.

use std::fmt;

use brain::command::StrategyName;
use brain::{BehaviorState, JobKind};
use robot::RobotSettings;
use rvac_sim::run::{core_config, start_cleaning};
use rvac_sim::{Host, Household, Scene};
use serde::Serialize;

/// Outcome of one job.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct JobOutcome {
    pub(crate) home: String,
    pub(crate) seed: u64,
    /// Ways home for charge, those that ended on the dock, and those after which the job went on.
    pub(crate) put_off: u32,
    pub(crate) came_home: u32,
    pub(crate) went_on: u32,
    /// Least true charge off the dock.
    pub(crate) least_charge: f64,
    /// Seconds on the dock in the middle of the job.
    pub(crate) charging_s: f64,
    /// Share of the reachable floor at the end, and when the battery was low first.
    pub(crate) swept: f64,
    pub(crate) swept_before: f64,
    /// Share of it that was cleaned in one part of the job and again in a later one.
    pub(crate) again: f64,
    /// The same of a job with a full pack, split into two parts at the same share: lanes overlap in any job.
    pub(crate) again_without_break: f64,
    pub(crate) job_s: f64,
    pub(crate) state: String,
    pub(crate) reason: String,
    pub(crate) violations: usize,
}

/// Cleaning empties the simulated pack in so many seconds.
const EMPTIES_S: f64 = 3_430.0;
/// A job takes so many T0.
const JOB_OVER_T0: f64 = 1.4;
/// The host turns home at this charge.
const LOW: f64 = 0.15;
/// Longest simulated time of a job.
const LONGEST_MS: u64 = 4 * 3_600_000;

impl JobOutcome {
    /// A job whose battery is low when about half of it is done. The pack fills `speed` times as fast as it would.
    /// `progress` is called with the approximate share that is done.
    pub(crate) fn of(scene: &Scene, seed: u64, speed: f64, mut progress: impl FnMut(f64)) -> Self {
        let settings = RobotSettings {
            seed,
            ..RobotSettings::default()
        };
        let robot = scene.robot(seed, &settings);
        let config = core_config(scene, seed, StrategyName::Systematic);
        let mut household = Household::new(robot, Host::start(0, config)).with_known_map();
        let half_s = 0.5 * JOB_OVER_T0 * scene.home().t0_s();
        let world = household.robot_mut().world_mut();
        world.set_battery_charge(LOW + half_s / EMPTIES_S);
        world.set_charging_speed(speed);
        world.begin_stretch();
        start_cleaning(&mut household, StrategyName::Systematic);
        let job = Self::finish(&mut household, seed, |swept| progress(0.5 * swept));
        let again = again_without_break(scene, seed, job.swept_before, |swept| {
            progress(0.5 + 0.5 * swept);
        });
        Self {
            again_without_break: again,
            ..job
        }
    }

    fn finish(household: &mut Household, seed: u64, mut progress: impl FnMut(f64)) -> Self {
        let mut watch = SecondSample::default();
        while household.robot().now_ms() < LONGEST_MS {
            household.pass_ms(1_000);
            progress(household.robot().world().truth().swept_share);
            if watch.second(household) {
                break;
            }
        }
        let world = household.robot().world();
        let status = household.host().map(Host::status);
        Self {
            home: world.home().name().to_owned(),
            seed,
            put_off: watch.put_off,
            came_home: watch.came_home,
            went_on: watch.went_on,
            least_charge: watch.least_charge.unwrap_or(1.0),
            charging_s: watch.charging_s,
            swept: world.truth().swept_share,
            swept_before: watch.swept_before.unwrap_or(0.0),
            again: world.cleaned_again_share(),
            again_without_break: 0.0,
            job_s: household.robot().now_ms() as f64 / 1_000.0,
            state: status
                .as_ref()
                .map_or_else(String::new, |status| status.state.clone()),
            reason: status
                .as_ref()
                .map_or_else(String::new, |status| status.reason.clone()),
            violations: household.robot().monitor().violations().len(),
        }
    }
}

fn again_without_break(scene: &Scene, seed: u64, from_share: f64, mut progress: impl FnMut(f64)) -> f64 {
    let settings = RobotSettings {
        seed,
        ..RobotSettings::default()
    };
    let config = core_config(scene, seed, StrategyName::Systematic);
    let robot = scene.robot(seed, &settings);
    let mut household = Household::new(robot, Host::start(0, config)).with_known_map();
    household.robot_mut().world_mut().begin_stretch();
    start_cleaning(&mut household, StrategyName::Systematic);
    let mut is_second = false;
    while household.robot().now_ms() < LONGEST_MS && !household.job_is_over() {
        household.pass_ms(1_000);
        let world = household.robot_mut().world_mut();
        progress(world.truth().swept_share);
        if !is_second && world.truth().swept_share >= from_share {
            is_second = true;
            world.begin_stretch();
        }
    }
    household.robot().world().cleaned_again_share()
}

/// What is noted each second.
#[derive(Default)]
struct SecondSample {
    goes_home: bool,
    waits: bool,
    put_off: u32,
    came_home: u32,
    went_on: u32,
    charging_s: f64,
    least_charge: Option<f64>,
    swept_before: Option<f64>,
}

impl SecondSample {
    /// A second is over; `true` when the job is.
    fn second(&mut self, household: &mut Household) -> bool {
        let Some(brain) = household.host().and_then(Host::brain) else {
            return false;
        };
        let (status, kind) = (brain.status(), brain.job_kind());
        let truth = *household.robot().world().truth();
        let goes_home = status.state == BehaviorState::Docking && status.reason.name() == "battery-low";
        let waits = status.reason.name() == "recharging";
        let cleans = status.state == BehaviorState::Cleaning;
        if goes_home && !self.goes_home {
            self.put_off += 1;
            self.swept_before.get_or_insert(truth.swept_share);
        }
        self.came_home += u32::from(waits && !self.waits && truth.docked);
        if cleans && self.came_home > self.went_on {
            self.went_on += 1;
            household.robot_mut().world_mut().begin_stretch();
        }
        if waits {
            self.charging_s += 1.0;
        }
        if !truth.docked {
            let least = self.least_charge.get_or_insert(truth.battery_charge);
            *least = least.min(truth.battery_charge);
        }
        (self.goes_home, self.waits) = (goes_home, waits);
        let rests = matches!(
            status.state,
            BehaviorState::Idle
                | BehaviorState::Docked
                | BehaviorState::Paused
                | BehaviorState::Stuck
                | BehaviorState::Error
        );
        rests
            && !waits
            && (kind.is_none() || kind != Some(JobKind::Dock) || status.state != BehaviorState::Docked)
    }
}

/// The figures of all jobs.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct JobsSummary {
    runs: usize,
    /// Jobs whose battery was low before their end.
    put_off: usize,
    /// Those that came home each time.
    came_home: usize,
    /// Those that went on each time, and ended by themselves.
    went_on: usize,
    finished: usize,
    /// Those that cleaned less than 5 % of the floor again beyond what a job without a break does.
    again_below_5_percent: usize,
    again_median: f64,
    again_without_break_median: f64,
    /// What was cleaned again beyond that: on the average, and at most.
    again_more_mean: f64,
    again_more_most: f64,
    /// The control: pairs of jobs without a break in the same home, one after the other, and those of which the second
    /// cleaned 5 % or more again beyond the first. So often the comparison alone says that a break was dear.
    control_pairs: usize,
    control_above_5_percent: usize,
    swept_median: f64,
    swept_before_median: f64,
    least_charge: f64,
    violations: usize,
}

const AGAIN_MAX: f64 = 0.05;

impl JobsSummary {
    pub(crate) fn of(jobs: &[JobOutcome]) -> Self {
        let put_off: Vec<&JobOutcome> = jobs.iter().filter(|job| job.put_off > 0).collect();
        let count = |is: fn(&JobOutcome) -> bool| put_off.iter().filter(|job| is(job)).count();
        let sorted = |figure: fn(&JobOutcome) -> f64| {
            let mut values: Vec<f64> = put_off.iter().map(|job| figure(job)).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let median = |figure: fn(&JobOutcome) -> f64| {
            let values = sorted(figure);
            values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
        };
        let more = sorted(|job| job.again - job.again_without_break);
        let control = control(&put_off);
        Self {
            runs: jobs.len(),
            put_off: put_off.len(),
            came_home: count(|job| job.came_home == job.put_off),
            went_on: count(|job| job.went_on == job.put_off),
            finished: count(|job| job.went_on == job.put_off && job.state == "docked"),
            again_below_5_percent: count(|job| job.again - job.again_without_break < AGAIN_MAX),
            again_median: median(|job| job.again),
            again_without_break_median: median(|job| job.again_without_break),
            again_more_mean: more.iter().sum::<f64>() / more.len() as f64,
            again_more_most: more.last().copied().unwrap_or(f64::NAN),
            control_pairs: control.len(),
            control_above_5_percent: control.iter().filter(|more| **more >= AGAIN_MAX).count(),
            swept_median: median(|job| job.swept),
            swept_before_median: median(|job| job.swept_before),
            least_charge: sorted(|job| job.least_charge)
                .first()
                .copied()
                .unwrap_or(f64::NAN),
            violations: jobs.iter().map(|job| job.violations).sum(),
        }
    }
}

/// How much more a job without a break cleaned again than another one in the same home.
fn control(jobs: &[&JobOutcome]) -> Vec<f64> {
    let same_home = jobs.windows(2).filter_map(|pair| match pair {
        [first, second] if first.home == second.home => Some((first, second)),
        _ => None,
    });
    same_home
        .map(|(first, second)| second.again_without_break - first.again_without_break)
        .collect()
}

impl fmt::Display for JobsSummary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            formatter,
            "{} jobs, battery low in {}: came home {}, went on {}, ended on the dock {}",
            self.runs, self.put_off, self.came_home, self.went_on, self.finished
        )?;
        writeln!(
            formatter,
            "cleaned again: {:.3} (without a break {:.3}), below 5 % more in {}; {:+.3} more on the average, {:.3} at most",
            self.again_median,
            self.again_without_break_median,
            self.again_below_5_percent,
            self.again_more_mean,
            self.again_more_most
        )?;
        writeln!(
            formatter,
            "control: of {} pairs of jobs without a break, {} differ by 5 % or more the same way",
            self.control_pairs, self.control_above_5_percent
        )?;
        writeln!(
            formatter,
            "swept {:.3}, {:.3} when the battery was low",
            self.swept_median, self.swept_before_median
        )?;
        write!(
            formatter,
            "least charge off the dock {:.3}; violations {}",
            self.least_charge, self.violations
        )
    }
}
