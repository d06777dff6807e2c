//! Start of a run: a robot in a home, and the host that drives it.

use std::sync::Arc;

use home::generate::GeneratedHome;
use home::{Beacons, Home, LongRanges, Noise, RobotModel};
use robot::RobotSettings;
use rvac_sim::bench::{BUDGET_S, NamedHome};
use rvac_sim::run::core_config;
use rvac_sim::{Host, Household, PoseSource, Scene};
use vthal_core::CoreConfig;

use crate::mode::{CleaningMode, SeededMode};

/// What all runs have in common.
#[derive(Clone, Debug)]
pub(crate) struct Setup {
    pub(crate) model: RobotModel,
    pub(crate) noise: Noise,
    pub(crate) board_gyro: GyroFitting,
    /// Radio beacons, of which the baseline hears none.
    pub(crate) radio: Option<Radio>,
}

/// Beacons at the edges of a home, and the errors of their ranges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Radio {
    pub(crate) beacons: usize,
    pub(crate) long: LongRanges,
    /// The last of them falls silent after so long.
    pub(crate) fails_after_ms: Option<u64>,
}

impl Radio {
    fn in_home(&self, scene: &Scene, seed: u64) -> Beacons {
        let beacons = scene.beacons(seed, self.beacons).with_long_ranges(self.long);
        match self.fails_after_ms {
            Some(after_ms) => beacons.with_failure(after_ms),
            None => beacons,
        }
    }
}

/// Whether the robot's Linux board has a gyro.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum GyroFitting {
    Absent,
    Fitted,
}

/// A home as it is and as it was when an old map of it was made.
#[derive(Clone, Debug)]
pub(crate) struct HomeWithHistory {
    pub(crate) scene: Scene,
    first_day: Arc<Home>,
}

impl HomeWithHistory {
    pub(crate) fn new(home: Arc<Home>, first_day: Arc<Home>, setup: &Setup) -> Self {
        Self {
            scene: Scene::new(home, setup.model.clone(), setup.noise),
            first_day,
        }
    }

    /// The home, and how it was on its first day, empty, where there is another day.
    pub(crate) fn of(named: &NamedHome, setup: &Setup) -> anyhow::Result<Self> {
        let home = Arc::new(named.home(&setup.model)?);
        let first_day = match named {
            NamedHome::Generated(today) if *today != GeneratedHome::number(today.number) => {
                Arc::new(GeneratedHome::number(today.number).home(&setup.model)?)
            }
            NamedHome::Generated(_) | NamedHome::File(_) | NamedHome::Trap(_) => Arc::clone(&home),
        };
        Ok(Self::new(home, first_day, setup))
    }

    /// A robot and a host for a mode.
    pub(crate) fn household(&self, setup: &Setup, way: SeededMode) -> Household {
        let SeededMode { mode, seed } = way;
        let settings = RobotSettings {
            seed,
            ..RobotSettings::default()
        };
        let robot = self.scene.robot(seed, &settings);
        let household = Household::new(robot, Host::start(0, self.config(way)));
        let household = match setup.board_gyro {
            GyroFitting::Absent => household,
            GyroFitting::Fitted => household.with_board_gyro(self.scene.board_gyro(seed)),
        };
        let household = match &setup.radio {
            Some(radio) if mode.listens() => household.with_beacons(radio.in_home(&self.scene, seed)),
            Some(_) | None => household,
        };
        match mode {
            CleaningMode::Bounce
            | CleaningMode::BeaconBounce
            | CleaningMode::FirstRun
            | CleaningMode::LearntMap => household,
            CleaningMode::KnownMap => household.with_known_map(),
            CleaningMode::OldMap => household.with_map_of(&self.first_day),
            CleaningMode::PerfectPose => household.with_known_map().with_pose_source(PoseSource::Truth),
        }
    }

    fn config(&self, SeededMode { mode, seed }: SeededMode) -> CoreConfig {
        CoreConfig {
            task_budget_s: BUDGET_S,
            ..core_config(&self.scene, seed, mode.strategy())
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use home::{Home, Noise, RobotModel};
    use rvac_sim::bench::BUDGET_S;
    use rvac_sim::run::core_config;
    use vthal_core::CoreConfig;

    use super::{GyroFitting, HomeWithHistory, Setup};
    use crate::mode::{CleaningMode, SeededMode};

    const PLAN: &str =
        "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0, 0], [2, 0], [2, 2], [0, 2]]\n";

    #[test]
    fn the_host_is_told_what_a_single_run_tells_it() {
        for name in ["sr8730", "relax"] {
            let model = RobotModel::by_name(name).unwrap();
            let home = Arc::new(Home::from_floorplan("room", PLAN, &model).unwrap());
            let setup = Setup {
                model,
                noise: Noise::ideal(),
                board_gyro: GyroFitting::Absent,
                radio: None,
            };
            let ground = HomeWithHistory::new(Arc::clone(&home), home, &setup);
            let single = core_config(&ground.scene, 3, CleaningMode::FirstRun.strategy());
            assert_eq!(single.sensors, ground.scene.sensors(), "{name}");
            let wanted = CoreConfig {
                task_budget_s: BUDGET_S,
                ..single
            };
            let told = ground.config(SeededMode {
                mode: CleaningMode::FirstRun,
                seed: 3,
            });
            assert_eq!(format!("{told:?}"), format!("{wanted:?}"), "{name}");
        }
    }
}
