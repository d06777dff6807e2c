//! `bench-sim`: how many times as fast as real time the simulator is, and what takes the time. `cargo xtask bench sim` builds
//! and runs it.
//!
//! A household works for some time, job after job, on one thread. Then the same is run again, as equal seeds allow, to see what
//! its parts take: the host is measured at its border, the world and the brain are run apart with what they were given. So
//! each figure is of a part that is busy alone, and the whole is measured without any of that.
#![forbid(unsafe_code)]

mod apart;
#[path = "../../progress.rs"]
mod progress;
mod table;

use std::io::{self, Write};
use std::path::PathBuf;
use std::time::Instant;

use brain::command::StrategyName;
use clap::Parser;
use robot::RobotSettings;
use rvac_sim::run::{core_config, keep_working, start_cleaning};
use rvac_sim::{CalibrationChoice, GyroFitted, Host, Household, Scene, SceneSettings, thread_processor_s};
use vthal_core::{CoreConfig, Recording};

use apart::{HouseholdCopies, clock_s};
use progress::Progress;
use table::{CaseFigures, table};

/// Measures the simulator.
#[derive(Debug, Parser)]
struct Arguments {
    /// Home: a ROS map .yaml, a Valetudo map .json, a home .toml, or generated:N.
    #[arg(long, default_value = "homes/two-room-flat.toml")]
    home: PathBuf,
    /// Robot by name.
    #[arg(long, default_value = "sr8730")]
    robot: String,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Simulated minutes of each case.
    #[arg(long, default_value_t = 60, value_parser = clap::value_parser!(u64).range(1..=600))]
    minutes: u64,
    /// Tell what the time is spent on, too, which takes three times as long.
    #[arg(long)]
    parts: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// The robot's task and what it is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Case {
    Bounce,
    FirstRun,
    KnownMap,
}

impl Case {
    const ALL: [Self; 3] = [Self::Bounce, Self::FirstRun, Self::KnownMap];

    const fn name(self) -> &'static str {
        match self {
            Self::Bounce => "bounce",
            Self::FirstRun => "systematic, first run",
            Self::KnownMap => "systematic, known map",
        }
    }

    const fn strategy(self) -> StrategyName {
        match self {
            Self::Bounce => StrategyName::Bounce,
            Self::FirstRun | Self::KnownMap => StrategyName::Systematic,
        }
    }

    /// A household that was asked to clean.
    fn household(self, scene: &Scene, seed: u64, recording: Recording) -> Household {
        let settings = RobotSettings {
            seed,
            ..RobotSettings::default()
        };
        let config = CoreConfig {
            recording,
            ..core_config(scene, seed, self.strategy())
        };
        let mut host = Host::start(0, config);
        if recording == Recording::On {
            host.keep_records();
        }
        let household = Household::new(scene.robot(seed, &settings), host);
        match self {
            Self::Bounce | Self::FirstRun => household,
            Self::KnownMap => household.with_known_map(),
        }
    }
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let scene = Scene::load(&SceneSettings {
        home: arguments.home.clone(),
        robot: arguments.robot.clone(),
        noise: "nominal".to_owned(),
        firmware: None,
        record: CalibrationChoice::Complete,
        gyro: GyroFitted::Placeholder,
    })?;
    let progress = Progress::new("simulator");
    let mut figures = Vec::new();
    for (number, case) in Case::ALL.into_iter().enumerate() {
        figures.push(measure(&scene, case, &arguments, |share| {
            progress.show((number as f64 + share) / Case::ALL.len() as f64);
        })?);
    }
    progress.clear();
    let mut out = io::stdout().lock();
    if arguments.json {
        let home = scene.home().name();
        writeln!(
            out,
            "{}",
            serde_json::json!({ "home": home, "minutes": arguments.minutes, "cases": figures })
        )?;
    } else {
        writeln!(
            out,
            "{}, {} minutes of each\n{}",
            scene.home().name(),
            arguments.minutes,
            table(&figures)
        )?;
    }
    Ok(())
}

fn measure(
    scene: &Scene,
    case: Case,
    arguments: &Arguments,
    mut progress: impl FnMut(f64),
) -> anyhow::Result<CaseFigures> {
    let passes = if arguments.parts { 3.0 } else { 1.0 };
    let work = Work {
        case,
        seconds: 60 * arguments.minutes,
    };
    let mut household = case.household(scene, arguments.seed, Recording::Off);
    let (began, began_s) = (Instant::now(), thread_processor_s());
    run(&mut household, work, |share| progress(share / passes));
    let (wall_seconds, processor_s) = (began.elapsed().as_secs_f64(), thread_processor_s() - began_s);
    let hash = household.robot().state_hash();
    let parts = arguments.parts.then(|| {
        let mut again = case.household(scene, arguments.seed, Recording::Off);
        let host_s = host_s(&mut again, work, |share| progress((1.0 + share) / passes));
        let recorded = case.household(scene, arguments.seed, Recording::On);
        let parts = taken_apart(recorded, work, |share| progress((2.0 + share) / passes));
        parts.shares(hash, processor_s, host_s)
    });
    let sim_seconds = household.robot().now_ms() as f64 / 1000.0;
    Ok(CaseFigures {
        case: case.name(),
        sim_seconds,
        wall_seconds,
        processor_s,
        times_real_time: sim_seconds / processor_s,
        parts: parts.transpose()?,
    })
}

/// So many seconds of a case.
#[derive(Clone, Copy, Debug)]
struct Work {
    case: Case,
    seconds: u64,
}

/// Does the work.
fn run(household: &mut Household, Work { case, seconds }: Work, mut progress: impl FnMut(f64)) {
    start_cleaning(household, case.strategy());
    for second in 0..seconds {
        household.pass_ms(1_000);
        keep_working(household, case.strategy());
        progress(second as f64 / seconds as f64);
    }
}

/// Processor time of the host's core.
fn host_s(household: &mut Household, work: Work, progress: impl FnMut(f64)) -> f64 {
    if let Some(host) = household.host_mut() {
        host.measure_cost();
    }
    run(household, work, progress);
    let cost = household.host().and_then(Host::cost).unwrap_or_default();
    cost.processor_s - f64::from(cost.steps) * clock_s()
}

fn taken_apart(
    household: Household,
    Work { case, seconds }: Work,
    mut progress: impl FnMut(f64),
) -> HouseholdCopies {
    let mut parts = HouseholdCopies::begin(household, case.strategy());
    for second in 0..seconds {
        parts.second(case.strategy());
        progress(second as f64 / seconds as f64);
    }
    parts
}
