//! Traps: whether the robot frees itself from places in which robots get stuck, and whether it stops where there is no
//! exit.
//!
//! *Free*: its middle has left the trap. *Ended*: free, or it said by itself that it cannot go on: stuck, a fault, or the job's
//! end.

use std::fmt;

use brain::BehaviorState;
use home::Pose;
use home::traps::{Trap, TrapBounds, TrapKind};
use rvac_sim::Household;
use rvac_sim::bench::NamedHome;
use rvac_sim::run::start_cleaning;
use serde::Serialize;

use crate::ground::{HomeWithHistory, Setup};
use crate::mode::{CleaningMode, SeededMode};

/// Nobody waits longer for an end.
const LONGEST_S: u64 = 2_400;

/// What became of a robot in a trap.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct TrapRun {
    mode: CleaningMode,
    kind: &'static str,
    seed: u32,
    can_be_left: bool,
    /// Seconds of the job until it was free.
    free_s: Option<f64>,
    /// Seconds of the job until it was free or gave up; `null` = neither.
    ended_s: Option<f64>,
    /// State and reason at the end.
    state: String,
    reason: String,
    violations: u32,
}

impl TrapRun {
    pub(crate) fn of(trap: Trap, setup: &Setup, mode: CleaningMode) -> anyhow::Result<Self> {
        let ground = HomeWithHistory::of(&NamedHome::Trap(trap), setup)?;
        let mut household = ground.household(
            setup,
            SeededMode {
                mode,
                seed: u64::from(trap.seed),
            },
        );
        anyhow::ensure!(
            start_cleaning(&mut household, mode.strategy()),
            "the robot does not answer"
        );
        let begun_ms = household.robot().now_ms();
        let bounds = trap.bounds();
        let job_s = |household: &Household| (household.robot().now_ms() - begun_ms) as f64 / 1000.0;
        let mut is_free = false;
        let mut has_ended = false;
        while !is_free && !has_ended && job_s(&household) < LONGEST_S as f64 {
            household.pass_ms(100);
            is_free = is_outside(&household, &bounds);
            has_ended = gave_up(&household);
        }
        let now_s = job_s(&household);
        let brain = household.host().and_then(rvac_sim::Host::brain);
        let (state, reason) = brain.map_or(("unknown", "unknown"), |brain| {
            (brain.status().state.name(), brain.status().reason.name())
        });
        Ok(Self {
            mode,
            kind: trap.kind.name(),
            seed: trap.seed,
            can_be_left: trap.kind.can_be_left(),
            free_s: is_free.then_some(now_s),
            ended_s: (is_free || has_ended).then_some(now_s),
            state: state.to_owned(),
            reason: reason.to_owned(),
            violations: household.robot().monitor().count(),
        })
    }
}

fn is_outside(household: &Household, bounds: &TrapBounds) -> bool {
    let world = household.robot().world();
    let (pose, corner) = (world.truth().pose, world.home().file_from_plan());
    !bounds.contains(Pose::new(pose.x_m + corner.x_m, pose.y_m + corner.y_m, 0.0))
}

/// Whether the host says that it will not go on by itself.
fn gave_up(household: &Household) -> bool {
    use BehaviorState::{Docked, Error, Idle, Paused, Stuck};
    let state = household.host().and_then(rvac_sim::Host::state);
    matches!(state, Some(Docked | Error | Idle | Paused | Stuck)) && household.job_is_over()
}

/// Shares and times of each mode and kind.
pub(crate) struct TrapTable<'runs> {
    runs: &'runs [TrapRun],
    modes: &'runs [CleaningMode],
}

/// Figures over some runs.
#[derive(Clone, Debug, Serialize)]
struct TrapFigures {
    runs: usize,
    /// Share of the runs in traps with an exit in which the robot came free; `null` = there was none.
    freed: Option<f64>,
    /// Share of all runs that ended.
    ended: f64,
    /// Seconds until the end: median and 90th percentile of those that ended.
    ended_median_s: Option<f64>,
    ended_p90_s: Option<f64>,
    violations: u32,
}

impl TrapFigures {
    fn of<'runs>(runs: impl Iterator<Item = &'runs TrapRun>) -> Self {
        let runs: Vec<&TrapRun> = runs.collect();
        let share = |part: usize, all: usize| part as f64 / all.max(1) as f64;
        let open = runs.iter().filter(|run| run.can_be_left).count();
        let freed = runs
            .iter()
            .filter(|run| run.can_be_left && run.free_s.is_some())
            .count();
        let mut ends_s: Vec<f64> = runs.iter().filter_map(|run| run.ended_s).collect();
        ends_s.sort_by(f64::total_cmp);
        let rank = |share: f64| {
            let rank = (share * ends_s.len() as f64).ceil() as usize;
            rank.checked_sub(1).and_then(|index| ends_s.get(index)).copied()
        };
        Self {
            runs: runs.len(),
            freed: (open > 0).then(|| share(freed, open)),
            ended: share(ends_s.len(), runs.len()),
            ended_median_s: rank(0.5),
            ended_p90_s: rank(0.9),
            violations: runs.iter().map(|run| run.violations).sum(),
        }
    }
}

impl<'runs> TrapTable<'runs> {
    pub(crate) const fn of(runs: &'runs [TrapRun], modes: &'runs [CleaningMode]) -> Self {
        Self { runs, modes }
    }

    fn rows(&self) -> Vec<(String, CleaningMode, TrapFigures)> {
        let mut rows = Vec::new();
        let kinds = TrapKind::ALL.iter().map(|kind| Some(kind.name()));
        for kind in kinds.chain([None]) {
            for mode in self.modes {
                let chosen = |run: &&TrapRun| run.mode == *mode && kind.is_none_or(|kind| kind == run.kind);
                let figures = TrapFigures::of(self.runs.iter().filter(chosen));
                rows.push((kind.unwrap_or("all").to_owned(), *mode, figures));
            }
        }
        rows
    }

    /// The figures as JSON: kind, then mode.
    pub(crate) fn json(&self) -> serde_json::Value {
        let mut kinds = serde_json::Map::new();
        for (kind, mode, figures) in self.rows() {
            let of_kind = kinds.entry(kind).or_insert_with(|| serde_json::json!({}));
            of_kind[mode.name()] = serde_json::json!(figures);
        }
        kinds.into()
    }
}

impl fmt::Display for TrapTable<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            formatter,
            "{:<14} {:<12} {:>5} {:>7} {:>7} {:>9} {:>9} {:>10}",
            "trap", "mode", "runs", "freed", "ended", "median s", "90 % s", "violations"
        )?;
        let percent = |share: Option<f64>| {
            share.map_or_else(|| "-".to_owned(), |share| format!("{:.1} %", 100.0 * share))
        };
        let seconds =
            |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.0}"));
        for (kind, mode, figures) in self.rows() {
            writeln!(
                formatter,
                "{kind:<14} {:<12} {:>5} {:>7} {:>7} {:>9} {:>9} {:>10}",
                mode.name(),
                figures.runs,
                percent(figures.freed),
                percent(Some(figures.ended)),
                seconds(figures.ended_median_s),
                seconds(figures.ended_p90_s),
                figures.violations
            )?;
        }
        Ok(())
    }
}
