//! One run: a mode, a home, a seed.

use std::time::Instant;

use brain::command::StrategyName;
use home::Home;
use robot::RobotSettings;
use rvac_sim::run::{RunEnd, start_cleaning};
use rvac_sim::{Figures, Host, HostCost, Household, PoseSource, Scene};
use serde::Serialize;
use vthal_core::CoreConfig;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Mode {
    Bounce,
    KnownMap,
    OldMap,
    FirstRun,
    PerfectPose,
}

impl Mode {
    const ALL: [Self; 5] = [
        Self::Bounce,
        Self::KnownMap,
        Self::OldMap,
        Self::FirstRun,
        Self::PerfectPose,
    ];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Bounce => "bounce",
            Self::KnownMap => "known-map",
            Self::OldMap => "old-map",
            Self::FirstRun => "first-run",
            Self::PerfectPose => "perfect-pose",
        }
    }

    pub(crate) fn list(text: &str) -> anyhow::Result<Vec<Self>> {
        let named = |name: &str| Self::ALL.into_iter().find(|mode| mode.name() == name);
        text.split(',')
            .map(|name| named(name.trim()).ok_or_else(|| anyhow::anyhow!("there is no mode `{name}`")))
            .collect()
    }

    pub(crate) const fn strategy(self) -> StrategyName {
        match self {
            Self::Bounce => StrategyName::Bounce,
            Self::KnownMap | Self::OldMap | Self::FirstRun | Self::PerfectPose => StrategyName::Systematic,
        }
    }

    /// Bounce knows no end, so it has had its chance when 95 % are swept.
    const fn end(self) -> RunEnd {
        match self {
            Self::Bounce => RunEnd::Covered,
            Self::KnownMap | Self::OldMap | Self::FirstRun | Self::PerfectPose => RunEnd::JobOver,
        }
    }
}

/// The figures of a run.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Run {
    pub(crate) mode: Mode,
    pub(crate) home: String,
    pub(crate) seed: u64,
    pub(crate) t0_s: f64,
    pub(crate) covered: f64,
    pub(crate) stuck: u32,
    pub(crate) foot_contacts: u32,
    pub(crate) foot_pushed_max_ms: u32,
    pub(crate) violations: u32,
    pub(crate) sim_seconds: f64,
    pub(crate) wall_seconds: f64,
    pub(crate) host_cost: HostCost,
    #[serde(flatten)]
    pub(crate) figures: Figures,
}

/// The battery is filled up so often, milliseconds: what energy allows is another measurement.
const REFILL_MS: u64 = 300_000;
/// So much more than the longest cleaning may pass, for the way home.
const HOMING_MS: u64 = 1_200_000;
/// Longest job that the host allows itself in these runs, seconds.
const BUDGET_S: u32 = 86_400;

impl Run {
    pub(crate) fn of(
        (scene, first_day): (&Scene, &Home),
        (mode, seed): (Mode, u64),
        longest: f64,
        mut progress: impl FnMut(f64),
    ) -> Self {
        let started = Instant::now();
        let mut household = household((scene, first_day), mode, seed);
        if let Some(host) = household.host_mut() {
            host.measure_cost();
        }
        start_cleaning(&mut household, mode.strategy());
        let duration_ms = (scene.home().t0_s() * longest * 1000.0) as u64 + HOMING_MS;
        while household.robot().now_ms() < duration_ms && !mode.end().is_reached(&household) {
            household.pass_ms(1_000);
            let now_ms = household.robot().now_ms();
            if now_ms % REFILL_MS < 1_000 {
                household.robot_mut().world_mut().set_battery_charge(1.0);
            }
            progress(now_ms as f64 / duration_ms as f64);
        }
        let report = household.report();
        Self {
            mode,
            home: report.home,
            seed,
            t0_s: report.t0_s,
            covered: report.covered,
            stuck: report.stuck,
            foot_contacts: report.foot_contacts,
            foot_pushed_max_ms: report.foot_pushed_max_ms,
            violations: report.monitor_violations,
            sim_seconds: report.sim_seconds,
            wall_seconds: started.elapsed().as_secs_f64(),
            host_cost: household.host().and_then(Host::cost).unwrap_or_default(),
            figures: report.figures.map_or_else(Figures::default, |figures| *figures),
        }
    }
}

/// A robot and a host for a mode. `first_day` is the home as it was when its map was made, where the mode has an old map.
pub(crate) fn household((scene, first_day): (&Scene, &Home), mode: Mode, seed: u64) -> Household {
    let settings = RobotSettings {
        seed,
        ..RobotSettings::default()
    };
    let robot = scene.robot(seed, &settings);
    let config = CoreConfig {
        task_budget_s: BUDGET_S,
        sensors: scene.sensors(),
        ..Host::config(seed, mode.strategy())
    };
    let household = Household::new(robot, Host::start(0, config));
    match mode {
        Mode::Bounce | Mode::FirstRun => household,
        Mode::KnownMap => household.with_known_map(),
        Mode::OldMap => household.with_map_of(first_day),
        Mode::PerfectPose => household.with_known_map().with_pose_source(PoseSource::Truth),
    }
}
