//! `bench-localization`: drives through homes once, and shows what was perceived to brains with many seeds.
//! `cargo xtask bench localization` builds and runs it.
#![forbid(unsafe_code)]

use std::io::{self, Write};
use std::ops::RangeInclusive;
use std::sync::Arc;

use anyhow::{Context, ensure};
use brain::command::StrategyName;
use clap::Parser;
use home::{Noise, RobotModel};
use robot::RobotSettings;
use rvac_sim::bench::{BUDGET_S, NamedHome, REFILL_MS, in_order};
use rvac_sim::replay::{Drive, DriveRecorder, ReplayFigures};
use rvac_sim::run::{RunEnd, core_config, start_cleaning};
use rvac_sim::{Host, Household, Scene};
use serde::Serialize;
use vthal_core::{CoreConfig, Recording};

/// Measures how much of the error of the place is chance of the filter.
#[derive(Debug, Parser)]
struct Arguments {
    /// Homes, separated by commas, as of `bench navigation`.
    #[arg(long, default_value = "homes/two-room-flat.toml,homes/empty-halls.toml")]
    homes: String,
    /// Seed of the robot and its home.
    #[arg(long, default_value_t = 1)]
    drive: u64,
    /// Seeds of the replays: A..B with B.
    #[arg(long, default_value = "1..6", value_parser = seeds)]
    seeds: RangeInclusive<u64>,
    /// Longest drive, simulated minutes.
    #[arg(long, default_value_t = 120, value_parser = clap::value_parser!(u64).range(1..=1_440))]
    minutes: u64,
    /// Noise class: ideal, good, nominal or bad; parts of it can differ, as in `nominal,gyro=0,wheel-scale=2`.
    #[arg(long, default_value = "nominal")]
    noise: String,
    /// The robot does not know the home yet.
    #[arg(long)]
    first_run: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

fn seeds(text: &str) -> anyhow::Result<RangeInclusive<u64>> {
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    let seeds = first.parse()?..=last.parse()?;
    ensure!(!seeds.is_empty(), "`{text}` names no seed");
    Ok(seeds)
}

/// A drive and its replays.
#[derive(Debug, Serialize)]
struct Replays {
    home: String,
    area_m2: f64,
    drive_s: f64,
    covered: f64,
    replays: Vec<SeededReplay>,
}

#[derive(Debug, Serialize)]
struct SeededReplay {
    seed: u64,
    #[serde(flatten)]
    figures: ReplayFigures,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let model = RobotModel::by_name("sr8730")?;
    let noise: Noise = arguments.noise.parse()?;
    let places = NamedHome::list(&arguments.homes)?;
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut all = Vec::new();
    for place in places {
        let scene = Scene::new(Arc::new(place.home(&model)?), model.clone(), noise);
        let (drive, mut replays) = drive(&scene, &arguments)?;
        let seeds: Vec<u64> = arguments.seeds.clone().collect();
        replays.replays = in_order(seeds.len(), threads, |_: &mut (), number| {
            let seed = seeds[number];
            Ok(SeededReplay {
                seed,
                figures: drive.replay(seed),
            })
        })?;
        if !arguments.json {
            print(&replays)?;
        }
        all.push(replays);
    }
    if arguments.json {
        let object =
            serde_json::json!({"noise": arguments.noise, "first_run": arguments.first_run, "homes": all});
        writeln!(io::stdout(), "{object}")?;
    }
    Ok(())
}

/// Cleans the home once.
fn drive(scene: &Scene, arguments: &Arguments) -> anyhow::Result<(Drive, Replays)> {
    let seed = arguments.drive;
    let settings = RobotSettings {
        seed,
        ..RobotSettings::default()
    };
    let strategy = StrategyName::Systematic;
    let config = CoreConfig {
        recording: Recording::On,
        task_budget_s: BUDGET_S,
        ..core_config(scene, seed, strategy)
    };
    let mut host = Host::start(0, config);
    host.keep_records();
    let mut household = Household::new(scene.robot(seed, &settings), host);
    if !arguments.first_run {
        household = household.with_known_map();
    }
    let mut recorder = DriveRecorder::default();
    ensure!(
        start_cleaning(&mut household, strategy),
        "the robot does not answer"
    );
    while household.robot().now_ms() < 60_000 * arguments.minutes {
        household.tick();
        recorder.note(&mut household);
        let now_ms = household.robot().now_ms();
        if now_ms.is_multiple_of(REFILL_MS) {
            household.robot_mut().world_mut().set_battery_charge(1.0);
        }
        if now_ms.is_multiple_of(1_000) && RunEnd::JobOver.is_reached(&household) {
            break;
        }
    }
    let report = household.report();
    let replays = Replays {
        home: report.home,
        area_m2: household.robot().world().home().reachable_area_m2(),
        drive_s: report.sim_seconds,
        covered: report.covered,
        replays: Vec::new(),
    };
    Ok((recorder.finish().context("no run began")?, replays))
}

fn print(replays: &Replays) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(
        out,
        "{}, {:.0} m2 reachable: {:.3} swept in {:.0} s",
        replays.home, replays.area_m2, replays.covered, replays.drive_s
    )?;
    writeln!(
        out,
        "  seed  rmse m  while sure   max m  lost s  unnoticed s    nees  beyond 3 sigma"
    )?;
    for SeededReplay { seed, figures } in &replays.replays {
        let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.3}"));
        writeln!(
            out,
            "{seed:6} {:>7} {:>11} {:7.2} {:7.0} {:12.0} {:>7} {:>15}",
            number(figures.rmse_m),
            number(figures.rmse_sure_m),
            figures.error_max_m,
            figures.lost_s,
            figures.unnoticed_s,
            number(figures.nees),
            number(figures.tail),
        )?;
    }
    Ok(())
}
