//! One run of a whole household at full speed.

use brain::command::{JobCommand, StrategyName};
use robot::RobotSettings;
use rvac_api::{CleaningPattern, JobOrder, RequestBody};
use vthal_core::CoreConfig;

use crate::{Host, Household, RunReport, Scene};

/// What is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunSettings {
    /// How to clean.
    pub strategy: StrategyName,
    /// The pattern for [`StrategyName::Systematic`]; without it the setting of the rooms.
    pub pattern: Option<CleaningPattern>,
    /// Seed of everything random.
    pub seed: u64,
    /// Simulated milliseconds from power-on, without those on the charger in the middle of the job.
    pub duration_ms: u64,
}

/// When a run ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RunEnd {
    /// When its time is over; that on the charger in the middle of a job does not count.
    #[default]
    Time,
    /// When the robot says that its job is over, and has docked or given that up; at latest when its time is over.
    JobOver,
    /// When 95 % are swept; else as [`Self::JobOver`].
    Covered,
}

impl RunEnd {
    /// Whether the run of this household shall end now, apart from its time.
    #[must_use]
    pub fn is_reached(self, household: &Household) -> bool {
        let settled = || {
            let state = household.host().and_then(Host::state);
            household.job_is_over() && state != Some(brain::BehaviorState::Docking)
        };
        match self {
            Self::Time => false,
            Self::JobOver => settled(),
            Self::Covered => household.reached_all_shares() || settled(),
        }
    }
}

/// The path is optimized and redrawn within this time after docking, milliseconds: what a robot keeps of its home is not there
/// before.
const SETTLE_MS: u64 = 30_000;

/// A robot that has just come to its dock gets the time to redraw its map.
fn settle(household: &mut Household) {
    let state = household.host().and_then(Host::state);
    if state == Some(brain::BehaviorState::Docked) {
        household.pass_ms(SETTLE_MS);
    }
}

/// The robot said nothing that its host understood.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the robot did not answer within {} s: the image must be a robot's whole firmware, with a link at 230,400 baud, or 38,400 on a Relax",
    CONNECT_MS / 1000
)]
pub struct NoAnswer;

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
    let config = core_config(scene, settings.seed, settings.strategy);
    Household::new(robot, Host::start(0, config))
}

/// What the host of a scene's robot begins with: no packet carries the positions of the sensors.
#[must_use]
pub fn core_config(scene: &Scene, seed: u64, strategy: StrategyName) -> CoreConfig {
    CoreConfig {
        sensors: scene.sensors(),
        ..Host::config(seed, strategy)
    }
}

/// Lets the household connect and asks it to clean. Gives `false` when the robot did not answer in time.
pub fn start_cleaning(household: &mut Household, strategy: StrategyName) -> bool {
    let start = RequestBody::Start {
        strategy: Some(strategy.name().to_owned()),
    };
    start_job(household, strategy, start)
}

/// A robot whose job is over is asked for the next one so often, milliseconds.
const ASK_MS: u64 = 5_000;

/// To be called each second: a household whose job is over is asked for the next one where it is, which may be the drive to the
/// dock.
pub fn keep_working(household: &mut Household, strategy: StrategyName) {
    if household.job_is_over() && household.robot().now_ms() % ASK_MS < 1_000 {
        household.ask(RequestBody::Start {
            strategy: Some(strategy.name().to_owned()),
        });
    }
}

/// A robot that has just described itself may not have reported yet: what it measures is unknown, and a job that needs it is refused. It
/// gets so long, milliseconds.
const FIRST_REPORT_MS: u64 = 200;

fn start_job(household: &mut Household, strategy: StrategyName, job: RequestBody) -> bool {
    let is_connected = (0..CONNECT_MS).any(|_| {
        household.tick();
        let host = household.host();
        host.is_some_and(|host| host.status().state != "disconnected")
    });
    if !is_connected {
        return false;
    }
    for _ in 0..FIRST_REPORT_MS {
        if admits(household, strategy) {
            break;
        }
        household.tick();
    }
    household.ask(job);
    true
}

fn admits(household: &Household, strategy: StrategyName) -> bool {
    let brain = household.host().and_then(Host::brain);
    brain.is_some_and(|brain| brain.admit(&JobCommand::Clean { strategy }).is_ok())
}

/// Cleans until the time is over. After each simulated second `progress` is called with the share of the time that has passed.
///
/// # Errors
/// [`NoAnswer`] when the robot cannot be asked to clean.
pub fn run(
    household: &mut Household,
    settings: &RunSettings,
    progress: impl FnMut(f64),
) -> Result<RunReport, NoAnswer> {
    run_until(household, (settings, RunEnd::Time), progress)
}

/// A job waits for charge for at most so long in all: a dock that gives none would hold a run for ever. Three charges of 6 h.
const CHARGING_MAX_MS: u64 = 18 * 3_600_000;

/// Cleans until the run's end. After each simulated second `progress` is called with the share of the longest time that has passed.
///
/// # Errors
/// [`NoAnswer`] when the robot cannot be asked to clean.
pub fn run_until(
    household: &mut Household,
    (settings, end): (&RunSettings, RunEnd),
    mut progress: impl FnMut(f64),
) -> Result<RunReport, NoAnswer> {
    let is_answered = match settings.pattern {
        Some(_) => start_job(
            household,
            settings.strategy,
            RequestBody::Clean(JobOrder {
                pattern: settings.pattern,
                ..JobOrder::default()
            }),
        ),
        None => start_cleaning(household, settings.strategy),
    };
    if !is_answered {
        return Err(NoAnswer);
    }
    let at_most_ms = settings.duration_ms.saturating_add(CHARGING_MAX_MS);
    while household.work_ms() < settings.duration_ms && household.robot().now_ms() < at_most_ms {
        household.tick();
        if household.robot().now_ms().is_multiple_of(1000) {
            progress(household.work_ms() as f64 / settings.duration_ms as f64);
            if end.is_reached(household) {
                settle(household);
                break;
            }
        }
    }
    Ok(household.report())
}
