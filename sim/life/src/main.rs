//! `bench-life`: how well a robot cleans its home run after run. `cargo xtask bench life` builds and runs it.
#![forbid(unsafe_code)]

use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use anyhow::Context;
use clap::Parser;
use home::RobotModel;
use life::{Chain, ChainSettings, ChangingHome, HomeChange, LifeRun, LifeTable, LivedHome, Wear};
use rvac_sim::bench::{NamedHome, in_order};
use rvac_sim::days::KeptDays;

/// Measures runs that follow each other, each with what the daemon kept of those before.
#[derive(Debug, Parser)]
struct Arguments {
    /// Homes, separated by commas: `report` and `tuning` (halves of the published set), `published` (both), `generated:A..B` with B,
    /// `generated:N`, or files.
    #[arg(long, default_value = "homes/two-room-flat.toml,generated:6,generated:14")]
    homes: String,
    /// Runs of each chain.
    #[arg(long, default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..))]
    runs: u32,
    /// Chains in each home: seeds 1 to this.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    seeds: u64,
    /// Robot by name.
    #[arg(long, default_value = "sr8730")]
    robot: String,
    /// Noise class: ideal, good, nominal or bad; parts of it can differ, as in `nominal,gyro=0,wheel-scale=2`.
    #[arg(long, default_value = "nominal")]
    noise: String,
    /// Chairs, boxes and toys stand 0.1 to 1 m from their places, elsewhere in each run from the second on.
    #[arg(long)]
    chairs: bool,
    /// A door is shut in every third run.
    #[arg(long)]
    doors: bool,
    /// The sofa is moved for good before run 10.
    #[arg(long)]
    sofa: bool,
    /// A rug is laid before run 15.
    #[arg(long)]
    rug: bool,
    /// People walk and stand about from the second run on.
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
    /// Keep the medians of each run in this folder, for `rvac-sim report`.
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,
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
            wear: self.wear(),
            new_robots: self.new_robots,
            timing: self.timing,
        })
    }

    const fn wear(&self) -> Wear {
        Wear {
            wheels: self.wheels_wear,
            gyro: self.gyro_warms,
            brush: self.brush_hardens,
        }
    }

    /// What the chains are called in a page.
    fn title(&self) -> String {
        let changes: Vec<String> = self
            .changes()
            .iter()
            .map(|change| format!("{change:?}").to_lowercase())
            .collect();
        let changed = if changes.is_empty() {
            "nothing moved".to_owned()
        } else {
            changes.join(", ")
        };
        format!(
            "{} in {}, noise {}, {} seeds: {changed}",
            self.robot, self.homes, self.noise, self.seeds
        )
    }

    fn changes(&self) -> BTreeSet<HomeChange> {
        let asked = [
            (self.chairs, HomeChange::Chairs),
            (self.doors, HomeChange::Doors),
            (self.sofa, HomeChange::Sofa),
            (self.rug, HomeChange::Rug),
            (self.people, HomeChange::People),
        ];
        let asked = asked.into_iter().filter(|(is_asked, _)| *is_asked);
        asked.map(|(_, change)| change).collect()
    }

    fn places(&self) -> anyhow::Result<Vec<LivedHome>> {
        let model = RobotModel::by_name(&self.robot)?;
        let changes = self.changes();
        let named = NamedHome::list(&self.homes)?;
        let lived = named.iter().map(|named| match (changes.is_empty(), named) {
            (true, _) => Ok(LivedHome::Fixed(Arc::new(named.home(&model)?))),
            (false, NamedHome::Generated(home)) => {
                let text = home.floorplan(&model)?;
                let home = ChangingHome::new(&format!("Generated {home}"), &text, &changes)?;
                Ok(LivedHome::Changing(home))
            }
            (false, NamedHome::File(path)) => {
                let name = path.display().to_string();
                let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {name}"))?;
                Ok(LivedHome::Changing(ChangingHome::new(&name, &text, &changes)?))
            }
            (false, NamedHome::Trap(_)) => anyhow::bail!("nobody lives in a trap"),
        });
        lived.collect()
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
    if let Some(folder) = &arguments.keep {
        let kept = KeptDays {
            title: arguments.title(),
            days: serde_json::from_value(serde_json::to_value(&table)?)?,
        };
        kept.keep(folder)?;
    }
    let mut out = io::stdout().lock();
    if arguments.json {
        let object = serde_json::json!({
            "homes": arguments.homes,
            "robot": arguments.robot,
            "noise": arguments.noise,
            "seeds": arguments.seeds,
            "changes": arguments.changes(),
            "wear": arguments.wear(),
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
    let seeds = arguments.seeds as usize;
    in_order(places.len() * seeds, arguments.jobs, |_: &mut (), number| {
        let place = &places[number / seeds];
        one(arguments, place, (number, (number % seeds) as u64 + 1))
    })
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
