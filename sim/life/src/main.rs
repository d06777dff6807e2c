//! `bench-life`: how well a robot cleans its home run after run. `cargo xtask bench life` builds and runs it.
#![forbid(unsafe_code)]

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use anyhow::Context;
use clap::Parser;
use home::generate::{GeneratedHome, Half};
use home::{Home, RobotModel};
use life::{Chain, ChainSettings, LifeRun, LifeTable, LivedHome, Wear};

/// Measures runs that follow each other, each with what the daemon kept of those before.
#[derive(Debug, Parser)]
struct Arguments {
    /// Homes, separated by commas: `report` and `tuning` (halves of the published set), `generated:N`, or files.
    #[arg(long, default_value = "homes/two-room-flat.toml,generated:6,generated:14")]
    homes: String,
    /// Runs of each chain.
    #[arg(long, default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..))]
    runs: u32,
    /// Chains in each home: seeds 1 to this.
    #[arg(long, default_value_t = 1)]
    seeds: u64,
    /// Robot by name.
    #[arg(long, default_value = "sr8730")]
    robot: String,
    /// Noise class: ideal, good, nominal or bad; parts of it can differ, as in `nominal,gyro=0,wheel-scale=2`.
    #[arg(long, default_value = "nominal")]
    noise: String,
    /// Chairs, boxes and toys of generated homes are elsewhere in each run.
    #[arg(long)]
    moved: bool,
    /// People walk and stand about in generated homes from the second run on. Implies --moved.
    #[arg(long)]
    people: bool,
    /// The radius of the wheels falls by half a thousandth a run.
    #[arg(long)]
    wheels_wear: bool,
    /// The gyro's bias follows the temperature of the robot.
    #[arg(long)]
    gyro_warms: bool,
    /// The brush's motor draws three hundredths more with each run.
    #[arg(long)]
    brush_hardens: bool,
    /// Each run has a robot of its own: other wheels, another gyro.
    #[arg(long)]
    new_robots: bool,
    /// Measure times of this machine, too; they differ from call to call.
    #[arg(long)]
    timing: bool,
    /// Chains at a time.
    #[arg(long, default_value_t = 2)]
    jobs: usize,
    /// Print one JSON object, with the figures of each run.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    fn settings(&self, seed: u64) -> anyhow::Result<ChainSettings> {
        Ok(ChainSettings {
            model: RobotModel::by_name(&self.robot)?,
            noise: self.noise.parse()?,
            runs: self.runs,
            seed,
            wear: Wear {
                wheels: self.wheels_wear,
                gyro: self.gyro_warms,
                brush: self.brush_hardens,
            },
            new_robots: self.new_robots,
            timing: self.timing,
        })
    }

    fn places(&self) -> anyhow::Result<Vec<LivedHome>> {
        let model = RobotModel::by_name(&self.robot)?;
        let generated = |home: GeneratedHome| self.generated(home, &model);
        let mut places = Vec::new();
        for name in self.homes.split(',').map(str::trim) {
            if let Some(half) = Half::named(name) {
                for number in half.numbers() {
                    places.push(generated(GeneratedHome::number(number))?);
                }
            } else if let Some(number) = name.strip_prefix("generated:") {
                let home = GeneratedHome::parse(number);
                places.push(generated(home.with_context(|| format!("`{name}` is no home"))?)?);
            } else {
                anyhow::ensure!(
                    !self.moved && !self.people,
                    "--moved and --people need generated homes, and `{name}` is a file"
                );
                places.push(LivedHome::Fixed(Arc::new(Home::load(Path::new(name), &model)?)));
            }
        }
        Ok(places)
    }

    fn generated(&self, home: GeneratedHome, model: &RobotModel) -> anyhow::Result<LivedHome> {
        if !self.moved && !self.people {
            return Ok(LivedHome::Fixed(Arc::new(home.home(model)?)));
        }
        let people = if self.people {
            home::generate::People::In
        } else {
            home::generate::People::Out
        };
        Ok(LivedHome::Moved(GeneratedHome { people, ..home }))
    }
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let places = arguments.places()?;
    let began = Instant::now();
    let chains = live(&arguments, &places)?;
    let simulated_s: f64 = chains.iter().flatten().map(|run| run.report.sim_seconds).sum();
    let speed = simulated_s / began.elapsed().as_secs_f64();
    writeln!(
        io::stderr(),
        "{simulated_s:.0} s simulated, {speed:.0} times real time with {} chains at a time",
        arguments.jobs
    )?;
    let table = LifeTable::of(&chains);
    let mut out = io::stdout().lock();
    if arguments.json {
        let object = serde_json::json!({
            "homes": arguments.homes,
            "robot": arguments.robot,
            "noise": arguments.noise,
            "seeds": arguments.seeds,
            "days": table,
            "chains": chains,
        });
        writeln!(out, "{object}")?;
    } else {
        writeln!(
            out,
            "{} chains in {}, noise {}: median (90th percentile) of each run\n{table}",
            chains.len(),
            arguments.homes,
            arguments.noise
        )?;
    }
    Ok(())
}

/// All chains, in the order of homes and seeds.
fn live(arguments: &Arguments, places: &[LivedHome]) -> anyhow::Result<Vec<Vec<LifeRun>>> {
    let count = places.len() * arguments.seeds as usize;
    let next = AtomicUsize::new(0);
    let results = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..arguments.jobs.clamp(1, count.max(1)) {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= count {
                        break;
                    }
                    let seed = (number % arguments.seeds as usize) as u64 + 1;
                    let place = &places[number / arguments.seeds as usize];
                    let result = one(arguments, place, (number, seed));
                    if let Ok(mut results) = results.lock() {
                        results.push((number, result));
                    }
                }
            });
        }
    });
    let mut results = results.into_inner().unwrap_or_default();
    results.sort_by_key(|(number, _)| *number);
    results.into_iter().map(|(_, result)| result).collect()
}

fn one(
    arguments: &Arguments,
    place: &LivedHome,
    (number, seed): (usize, u64),
) -> anyhow::Result<Vec<LifeRun>> {
    let settings = arguments.settings(seed)?;
    let state = StateFolder::new(number)?;
    Chain::new(place, &settings, &state.0).live(|run| {
        // Progress that cannot be shown does not stop a chain.
        writeln!(
            io::stderr(),
            "{}, seed {seed}, run {} of {}: swept {:.3}, {} bumps",
            run.report.home,
            run.run,
            arguments.runs,
            run.report.covered,
            run.report.bumps
        )
        .ok();
    })
}

/// A state folder that is removed in the end.
struct StateFolder(PathBuf);

impl StateFolder {
    fn new(number: usize) -> anyhow::Result<Self> {
        let path = std::env::temp_dir().join(format!("bench-life-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&path).with_context(|| format!("cannot make {}", path.display()))?;
        Ok(Self(path))
    }
}

impl Drop for StateFolder {
    fn drop(&mut self) {
        // What is left in the system's folder for temporary files harms nobody.
        std::fs::remove_dir_all(&self.0).ok();
    }
}
