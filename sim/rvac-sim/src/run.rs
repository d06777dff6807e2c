//! One run of a whole household at full speed.

use brain::command::StrategyName;
use robot::RobotSettings;
use rvac_api::RequestBody;

use crate::{Host, Household, Report, Scene};

/// What is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunSettings {
    /// How to clean.
    pub strategy: StrategyName,
    /// Seed of everything random.
    pub seed: u64,
    /// Simulated milliseconds, from power-on.
    pub duration_ms: u64,
}

/// Milliseconds that handshake and description may take.
const CONNECT_MS: u64 = 5_000;

/// A household whose robot was just switched on.
#[must_use]
pub fn household(scene: &Scene, settings: &RunSettings) -> Household {
    let robot = scene.robot(
        settings.seed,
        &RobotSettings {
            seed: settings.seed,
            ..RobotSettings::default()
        },
    );
    let config = Host::config(settings.seed, settings.strategy);
    Household::new(robot, Host::start(0, config))
}

/// Lets the household connect and asks it to clean. Gives `false` when the robot did not answer in time.
pub fn start_cleaning(household: &mut Household, strategy: StrategyName) -> bool {
    for _ in 0..CONNECT_MS {
        household.tick();
        if household
            .host()
            .is_some_and(|host| host.status().state != "disconnected")
        {
            household.ask(RequestBody::Start {
                strategy: Some(strategy.name().to_owned()),
            });
            return true;
        }
    }
    false
}

/// Cleans until the time is over. After each simulated second `progress` is told the share of the time that has passed.
pub fn run(household: &mut Household, settings: &RunSettings, mut progress: impl FnMut(f64)) -> Report {
    start_cleaning(household, settings.strategy);
    while household.robot().now_ms() < settings.duration_ms {
        household.tick();
        let now_ms = household.robot().now_ms();
        if now_ms.is_multiple_of(1000) {
            progress(now_ms as f64 / settings.duration_ms as f64);
        }
    }
    household.report()
}
