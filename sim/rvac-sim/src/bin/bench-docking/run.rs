//! One return to the dock.

use std::io::{self, Write};

use brain::BehaviorState;
use brain::command::StrategyName;
use home::{BeamStrengths, Pcg, wrap_angle};
use robot::RobotSettings;
use rvac_api::{LogEntry, RequestBody};
use rvac_sim::run::{core_config, start_cleaning};
use rvac_sim::{Host, Household, Scene, explain};
use serde::Serialize;

use crate::place;

/// From where the robot has to come home.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum DockingStart {
    Map,
    Lifted,
    Anywhere,
}

/// What goes wrong.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Obstacle {
    beams: bool,
    pushed: bool,
    pub(crate) bad_noise: bool,
}

/// Outcome of the run.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DockingRun {
    pub(crate) situation: DockingStart,
    pub(crate) home: String,
    pub(crate) seed: u64,
    pub(crate) docked: bool,
    /// From the request until the contacts closed, seconds.
    pub(crate) time_s: f64,
    /// Straight distance from the dock at the request, metres.
    pub(crate) distance_m: f64,
    /// Errors on the contacts.
    pub(crate) aside_m: f64,
    pub(crate) turned_deg: f64,
    pub(crate) state: String,
    pub(crate) reason: String,
    pub(crate) violations: usize,
    #[serde(skip)]
    log: Vec<LogEntry>,
}

/// Time after which the run is ended in any case: the robot's own limit is 60 minutes.
const LONGEST_MS: u64 = 3_750_000;
/// How long a robot works before it is lifted, and how long it is in the air.
const WORK_MS: u64 = 90_000;
const AIR_MS: u64 = 3_000;
/// How far the dock was pushed, metres and radians.
const PUSHED_M: f64 = 0.05;
const PUSHED_RAD: f64 = 0.052;
/// Stream of the draws of this bench.
const STREAM: u64 = 77;

impl DockingStart {
    const ALL: [Self; 3] = [Self::Map, Self::Lifted, Self::Anywhere];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::Lifted => "lifted",
            Self::Anywhere => "anywhere",
        }
    }

    pub(crate) fn list(text: &str) -> anyhow::Result<Vec<Self>> {
        let named = |name: &str| Self::ALL.into_iter().find(|situation| situation.name() == name);
        text.split(',')
            .map(|name| named(name.trim()).ok_or_else(|| anyhow::anyhow!("there is no situation `{name}`")))
            .collect()
    }
}

impl Obstacle {
    pub(crate) fn parse(text: &str) -> anyhow::Result<Self> {
        let mut found = Self::default();
        for name in text.split(',').map(str::trim).filter(|name| !name.is_empty()) {
            match name {
                "beams" => found.beams = true,
                "pushed" => found.pushed = true,
                "bad-noise" => found.bad_noise = true,
                other => anyhow::bail!("there is no fault `{other}`"),
            }
        }
        Ok(found)
    }
}

impl DockingRun {
    pub(crate) fn of(scene: &Scene, situation: DockingStart, seed: u64, obstacle: Obstacle) -> Self {
        let mut random = Pcg::new(seed, STREAM);
        let radius_m = 0.175;
        let there = place::draw(scene.home(), radius_m, &mut random);
        let settings = RobotSettings {
            seed,
            ..RobotSettings::default()
        };
        let start = (situation != DockingStart::Lifted).then_some(there);
        let robot = scene.robot_at(start, seed, &settings);
        let config = core_config(scene, seed, StrategyName::Systematic);
        let mut host = Host::start(0, config);
        host.keep_log();
        let mut household = Household::new(robot, host);
        if situation != DockingStart::Anywhere {
            household = household.with_known_map();
        }
        obstacle.apply(&mut household, &mut random);
        if situation == DockingStart::Lifted {
            start_cleaning(&mut household, StrategyName::Systematic);
            household.pass_ms(WORK_MS);
            household.robot_mut().world_mut().lift();
            household.pass_ms(AIR_MS);
            household.robot_mut().world_mut().put_down_at(there);
            household.pass_ms(6_000);
        } else {
            household.pass_ms(3_000);
        }
        Self::home(&mut household, situation, seed)
    }

    fn home(household: &mut Household, situation: DockingStart, seed: u64) -> Self {
        let from = household.robot().world().truth().pose;
        let dock = household.robot().world().docked_pose().unwrap_or(from);
        let begun_ms = household.robot().now_ms();
        household.ask(RequestBody::Dock);
        let mut docked_ms = None;
        while household.robot().now_ms() < begun_ms + LONGEST_MS {
            household.pass_ms(100);
            let state = household.host().and_then(Host::state);
            let now_ms = household.robot().now_ms();
            if household.robot().world().truth().docked && state == Some(BehaviorState::Docked) {
                docked_ms = Some(now_ms);
                break;
            }
            // A robot that slips off its contacts at once counts as docked for a moment.
            let waits = !matches!(
                state,
                Some(
                    BehaviorState::Docking
                        | BehaviorState::Docked
                        | BehaviorState::Starting
                        | BehaviorState::Disconnected
                )
            );
            if waits && now_ms > begun_ms + 10_000 {
                break;
            }
        }
        // The robot rolls to a stop.
        household.pass_ms(500);
        let truth = household.robot().world().truth().pose;
        let aside_m = dock.inverse().then(truth).y_m;
        let host = household.host().map(Host::status);
        Self {
            situation,
            home: household.robot().world().home().name().to_owned(),
            seed,
            docked: docked_ms.is_some(),
            time_s: (docked_ms.unwrap_or(household.robot().now_ms()) - begun_ms) as f64 / 1000.0,
            distance_m: from.distance_m(dock),
            aside_m: aside_m.abs(),
            turned_deg: wrap_angle(truth.heading_rad - dock.heading_rad)
                .abs()
                .to_degrees(),
            state: host
                .as_ref()
                .map_or_else(String::new, |status| status.state.clone()),
            reason: host
                .as_ref()
                .map_or_else(String::new, |status| status.reason.clone()),
            violations: household.robot().monitor().violations().len(),
            log: household.host().map_or_else(Vec::new, |host| host.log().to_vec()),
        }
    }

    /// Tells what the robot decided, most of a long story left out.
    pub(crate) fn explain(&self) -> anyhow::Result<()> {
        let mut out = io::stderr().lock();
        writeln!(
            out,
            "{} {} seed {}: {} {} after {:.0} s, {:.1} m",
            self.situation.name(),
            self.home,
            self.seed,
            self.state,
            self.reason,
            self.time_s,
            self.distance_m
        )?;
        Ok(explain(&self.log, &mut out)?)
    }
}

impl Obstacle {
    fn apply(self, household: &mut Household, random: &mut Pcg) {
        let world = household.robot_mut().world_mut();
        if self.beams {
            world.set_dock_beams(BeamStrengths::POOR);
        }
        if self.pushed {
            let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
            world.push_dock(side * PUSHED_M, PUSHED_RAD * random.symmetric());
        }
    }
}
