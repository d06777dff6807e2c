//! Runs that follow each other in one home.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use anyhow::Context;
use brain::BehaviorState;
use brain::command::StrategyName;
use home::{Home, Noise, Pcg, RobotModel, World, WorldSeeds};
use robot::RobotSettings;
use rvac_sim::run::{RunEnd, core_config, start_cleaning};
use rvac_sim::{Firmware, Host, Household, KeptWrite, Scene};
use vthal::KeptStore;
use vthal_core::CoreConfig;

use crate::changes::ChangingHome;
use crate::run::{LifeRun, LifeTiming};
use crate::wear::Wear;

/// Stream of the seeds of single runs.
const STREAM: u64 = 71;
/// Longest job, multiples of T0, and what a run may take besides for the way home, seconds.
const LONGEST_OVER_T0: f64 = 10.0;
const SPARE_S: f64 = 1_200.0;
/// After a run that came home the map is finished within so long, seconds.
const SETTLE_S: u32 = 30;
/// A pack charges so many times as fast in the middle of a job; the figures do not count that time.
const CHARGING_SPEED: f64 = 20.0;
/// Longest time on the charger in the middle of a job, seconds.
const CHARGING_MAX_S: f64 = 3_600.0;
/// The only floor.
const FLOOR: u16 = 1;

/// Where a robot lives.
#[derive(Clone, Debug)]
pub enum LivedHome {
    /// A home that is the same every day.
    Fixed(Arc<Home>),
    /// A home in which people change things.
    Changing(ChangingHome),
}

/// What all runs of a chain have in common.
#[derive(Clone, Debug)]
pub struct ChainSettings {
    /// Robot as its maker describes it.
    pub model: RobotModel,
    /// Its imperfections.
    pub noise: Noise,
    /// Runs.
    pub runs: u32,
    /// Seed of the chain.
    pub seed: u64,
    /// What wears.
    pub wear: Wear,
    /// Each run has a robot of its own instead of the same one.
    pub new_robots: bool,
    /// Times of this machine are measured, too.
    pub timing: bool,
}

/// One robot in one home.
#[derive(Debug)]
pub struct Chain<'a> {
    home: &'a LivedHome,
    settings: &'a ChainSettings,
    store: KeptStore,
}

impl LivedHome {
    /// The home on the day of a run, counted from 1, in the chain of a seed.
    fn on_day(&self, run: u32, (seed, model): (u64, &RobotModel)) -> anyhow::Result<Arc<Home>> {
        match self {
            Self::Fixed(home) => Ok(Arc::clone(home)),
            Self::Changing(home) => Ok(Arc::new(home.on_day(run, seed, model)?)),
        }
    }
}

impl<'a> Chain<'a> {
    /// A life whose daemons keep what they know in `state`, an empty folder.
    #[must_use]
    pub fn new(home: &'a LivedHome, settings: &'a ChainSettings, state: &Path) -> Self {
        Self {
            home,
            settings,
            store: KeptStore::new(state),
        }
    }

    /// All runs. `progress` is given the number of each that is done, and its figures.
    ///
    /// # Errors
    /// When a home cannot be drawn, a file cannot be written, or the robot does not answer.
    pub fn live(&self, mut progress: impl FnMut(&LifeRun)) -> anyhow::Result<Vec<LifeRun>> {
        let mut runs = Vec::new();
        for run in 1..=self.settings.runs {
            let done = self.run(run).with_context(|| format!("run {run}"))?;
            progress(&done);
            runs.push(done);
        }
        Ok(runs)
    }

    fn run(&self, run: u32) -> anyhow::Result<LifeRun> {
        let began = Instant::now();
        let seed = u64::from(Pcg::new(self.settings.seed, STREAM + u64::from(run)).next_u32());
        let home = self
            .home
            .on_day(run, (self.settings.seed, &self.settings.model))?;
        let scene = Scene::new(home, self.settings.model.clone(), self.settings.noise);
        let reading = Instant::now();
        let config = self
            .store
            .fill(core_config(&scene, seed, StrategyName::Systematic));
        anyhow::ensure!(config.complaints.is_empty(), "{}", config.complaints.join("; "));
        let mut timing = LifeTiming {
            read_ms: milliseconds(reading),
            ..LifeTiming::default()
        };
        let mut household = self.household(&scene, config, (run, seed));
        anyhow::ensure!(
            start_cleaning(&mut household, StrategyName::Systematic),
            "the robot did not answer"
        );
        self.clean(&mut household, &mut timing)?;
        timing.save_step_max_ms = step_max_ms(&mut household);
        let report = household.report();
        let now_us = household.now_us();
        if let Some(host) = household.host_mut() {
            host.shut_down(now_us);
        }
        self.write(&mut household, &mut timing)?;
        timing.shutdown_ms = step_max_ms(&mut household);
        timing.times_real_time = report.sim_seconds / began.elapsed().as_secs_f64();
        Ok(LifeRun {
            seed: self.settings.seed,
            run,
            map_bytes: self.store.newest_map(FLOOR).map(|bytes| bytes.len()),
            report,
            timing: self.settings.timing.then_some(timing),
        })
    }

    fn household(&self, scene: &Scene, config: CoreConfig, (run, seed): (u32, u64)) -> Household {
        let settings = self.settings;
        let seeds = WorldSeeds {
            build: if settings.new_robots { seed } else { settings.seed },
            run: seed,
        };
        let worn = settings.wear.model(&settings.model, run);
        let home = Arc::new(scene.home().clone());
        let mut world = World::new(home, &worn, &settings.noise, seeds, None);
        if let Some(docked) = world.docked_pose() {
            world.put_down_at(docked);
        }
        world.set_charging_speed(CHARGING_SPEED);
        let robot_settings = RobotSettings {
            seed,
            ..RobotSettings::default()
        };
        let robot = Firmware::HostBuilt.robot(&settings.model, world, &robot_settings);
        let mut host = Host::start(0, config);
        host.keep_writes();
        host.measure_cost();
        let mut household = Household::new(robot, host);
        settings.wear.begin(&mut household, run);
        household
    }

    /// Until the robot is home, or its time is over.
    fn clean(&self, household: &mut Household, timing: &mut LifeTiming) -> anyhow::Result<()> {
        let longest_s = LONGEST_OVER_T0 * household.robot().world().home().t0_s() + SPARE_S;
        let mut has_begun = false;
        while household.work_ms() as f64 / 1000.0 < longest_s
            && household.robot().now_ms() as f64 / 1000.0 < longest_s + CHARGING_MAX_S
            && !RunEnd::JobOver.is_reached(household)
        {
            self.second(household, timing)?;
            if !has_begun && household.host().and_then(Host::state) == Some(BehaviorState::Cleaning) {
                has_begun = true;
                timing.load_step_max_ms = step_max_ms(household);
            }
        }
        timing.job_step_max_ms = step_max_ms(household);
        for _ in 0..SETTLE_S {
            self.second(household, timing)?;
        }
        Ok(())
    }

    /// Ends with a full second, at which the figures take a sample.
    fn second(&self, household: &mut Household, timing: &mut LifeTiming) -> anyhow::Result<()> {
        household.pass_ms(1_000 - household.robot().now_ms() % 1_000);
        self.settings.wear.pass_second(household);
        self.write(household, timing)
    }

    /// What the daemon has written goes to the files.
    fn write(&self, household: &mut Household, timing: &mut LifeTiming) -> anyhow::Result<()> {
        let writes = household.host_mut().map(Host::take_writes).unwrap_or_default();
        for write in writes {
            let began = Instant::now();
            match write {
                KeptWrite::Home(home) => self.store.keep_home(&home)?,
                KeptWrite::Doubt(floor) => self.store.keep_doubt(floor)?,
                KeptWrite::Learnt(learnt) => self.store.keep_learnt(&learnt)?,
                KeptWrite::Health(health) => self.store.keep_health(&health)?,
                KeptWrite::Run(record) => {
                    self.store.keep_run(*record).map_err(anyhow::Error::msg)?;
                }
            }
            timing.write_max_ms = timing.write_max_ms.max(milliseconds(began));
        }
        Ok(())
    }
}

fn milliseconds(began: Instant) -> f64 {
    1_000.0 * began.elapsed().as_secs_f64()
}

fn step_max_ms(household: &mut Household) -> f64 {
    let cost = household.host_mut().map(Host::take_cost).unwrap_or_default();
    cost.step_max_us / 1_000.0
}
