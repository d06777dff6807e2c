//! Runs: a mode, a home, a seed.

use std::time::Instant;

use brain::StoredMap;
use brain::command::StrategyName;
use rvac_sim::bench::REFILL_MS;
use rvac_sim::run::{keep_working, start_cleaning};
use rvac_sim::{Figures, Host, HostCost, Household, RunReport};
use serde::Serialize;

use crate::ground::{HomeWithHistory, Setup};
use crate::mode::{CleaningMode, SeededMode};

/// The figures of a run.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct NavigationRun {
    pub(crate) mode: CleaningMode,
    /// Which run in this home it was, from 1.
    pub(crate) round: u32,
    pub(crate) home: String,
    pub(crate) seed: u64,
    pub(crate) t0_s: f64,
    pub(crate) covered: f64,
    /// Root mean square of the distance between believed and true place over the whole run; `null` = it has no estimate.
    pub(crate) pose_rmse_m: Option<f64>,
    pub(crate) stuck: u32,
    pub(crate) foot_contacts: u32,
    pub(crate) foot_pushed_max_ms: u32,
    pub(crate) violations: u32,
    /// Jobs that were begun.
    pub(crate) jobs: u32,
    pub(crate) sim_seconds: f64,
    pub(crate) wall_seconds: f64,
    pub(crate) host_cost: HostCost,
    #[serde(flatten)]
    pub(crate) figures: Figures,
}

/// How long a run lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Length {
    /// One job and the drive home, aborted after so many T0.
    OneJob { longest_over_t0: f64 },
    /// One job after the other for so long: as soon as one is over, the next begins where the robot is.
    Work { minutes: f64 },
}

/// A run may take so much more than its length: for the drive home, or until work begins.
const SPARE_MS: u64 = 1_200_000;

/// A job in lanes is refused until the radio has heard some beacons, so people wait for so long, milliseconds.
const RADIO_MS: u64 = 5_000;

/// Where robots run: a home, and what they run with.
#[derive(Debug)]
pub(crate) struct Ground<'a> {
    pub(crate) home: &'a HomeWithHistory,
    pub(crate) setup: &'a Setup,
}

/// All runs of a mode in a home with a seed, one after the other.
pub(crate) fn rounds(
    ground: &Ground<'_>,
    way: SeededMode,
    length: Length,
    mut progress: impl FnMut(f64),
) -> Vec<NavigationRun> {
    let mut map: Option<StoredMap> = None;
    let mut runs = Vec::new();
    let rounds = way.mode.rounds();
    for round in 1..=rounds {
        let mut household = ground.home.household(ground.setup, way);
        if ground.setup.radio.is_some() {
            household.pass_ms(RADIO_MS);
        }
        if let Some(map) = map {
            household = household.with_map(map);
        }
        let before = f64::from(round - 1);
        let run = one(&mut household, way, length, |share| {
            progress((before + share) / f64::from(rounds));
        });
        runs.push(NavigationRun { round, ..run });
        let brain = household.host().and_then(Host::brain);
        map = brain.map(|brain| brain.map().stored());
    }
    runs
}

fn one(
    household: &mut Household,
    SeededMode { mode, seed }: SeededMode,
    length: Length,
    progress: impl FnMut(f64),
) -> NavigationRun {
    let started = Instant::now();
    if let Some(host) = household.host_mut() {
        host.measure_cost();
    }
    start_cleaning(household, mode.strategy());
    let (first, jobs) = match length {
        Length::OneJob { longest_over_t0 } => {
            one_job(household, mode, longest_over_t0, progress);
            (None, 1)
        }
        Length::Work { minutes } => work(household, mode.strategy(), minutes, progress),
    };
    let last = household.report();
    let figures = figures(first.as_ref().unwrap_or(&last), &last);
    let report = first.unwrap_or_else(|| last.clone());
    NavigationRun {
        mode,
        round: 1,
        home: report.home,
        seed,
        t0_s: report.t0_s,
        covered: report.covered,
        pose_rmse_m: last.pose_rmse_m,
        stuck: last.stuck,
        foot_contacts: last.foot_contacts,
        foot_pushed_max_ms: last.foot_pushed_max_ms,
        violations: last.monitor_violations,
        jobs,
        sim_seconds: last.sim_seconds,
        wall_seconds: started.elapsed().as_secs_f64(),
        host_cost: household.host().and_then(Host::cost).unwrap_or_default(),
        figures,
    }
}

fn one_job(
    household: &mut Household,
    mode: CleaningMode,
    longest_over_t0: f64,
    mut progress: impl FnMut(f64),
) {
    let t0_s = household.robot().world().home().t0_s();
    let duration_ms = (t0_s * longest_over_t0 * 1000.0) as u64 + SPARE_MS;
    while household.robot().now_ms() < duration_ms && !mode.end().is_reached(household) {
        second(household);
        progress(household.robot().now_ms() as f64 / duration_ms as f64);
    }
    progress(1.0);
}

/// Gives what was reported at the end of the first job, if that came, and the number of jobs.
fn work(
    household: &mut Household,
    strategy: StrategyName,
    minutes: f64,
    mut progress: impl FnMut(f64),
) -> (Option<RunReport>, u32) {
    let length_s = 60.0 * minutes;
    let duration_ms = (1000.0 * length_s) as u64 + SPARE_MS;
    let (mut first, mut jobs, mut was_over) = (None, 1, false);
    while household.job_s() < length_s && household.robot().now_ms() < duration_ms {
        second(household);
        keep_working(household, strategy);
        let is_over = household.job_is_over();
        if is_over {
            first.get_or_insert_with(|| household.report());
        }
        jobs += u32::from(was_over && !is_over);
        was_over = is_over;
        progress(household.job_s() / length_s);
    }
    progress(1.0);
    (first, jobs)
}

/// Ends with a full second, at which the figures take a sample: so they describe the state at that moment.
fn second(household: &mut Household) {
    household.pass_ms(1_000 - household.robot().now_ms() % 1_000);
    if household.robot().now_ms() % REFILL_MS < 1_000 {
        household.robot_mut().world_mut().set_battery_charge(1.0);
    }
}

/// Quality of the job is that of the first one; quality of the pose and of the map is that of the whole run.
fn figures(first: &RunReport, last: &RunReport) -> Figures {
    let of = |report: &RunReport| report.figures.as_deref().cloned().unwrap_or_default();
    let (job, run) = (of(first), of(last));
    Figures {
        t80_over_t0: job.t80_over_t0,
        t90_over_t0: job.t90_over_t0,
        t95_over_t0: job.t95_over_t0,
        share_at_t0: job.share_at_t0,
        share_at_1_8_t0: job.share_at_1_8_t0,
        job_over_t0: job.job_over_t0,
        away_s: job.away_s,
        time_spent: job.time_spent,
        turn_deg_per_m2: job.turn_deg_per_m2,
        bumps_per_m2: job.bumps_per_m2,
        field: job.field,
        estimate_error: job.estimate_error,
        ..run
    }
}
