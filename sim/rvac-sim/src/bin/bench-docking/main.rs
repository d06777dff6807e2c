//! `bench-docking`: how surely, how fast and how exactly the robot comes home. `cargo xtask bench docking` builds and runs it.
#![forbid(unsafe_code)]

mod low_battery;
mod place;
#[path = "../../progress.rs"]
mod progress;
mod run;
mod table;
mod worn;

use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

use anyhow::Context;
use clap::Parser;
use home::generate::{GeneratedHome, Half};
use home::{Home, Noise, RobotModel};
use rvac_sim::Scene;

use low_battery::{JobOutcome, JobsSummary};
use progress::Progress;
use run::{DockingRun, DockingStart, Obstacle};
use table::DockingTable;
use worn::{WornSummary, WornTrial};

/// Measures docking in generated homes.
#[derive(Debug, Parser)]
struct Arguments {
    /// Homes: `tuning` or `report` (odd and even numbers of the published set), or `small` (two homes of the project).
    #[arg(long, default_value = "report")]
    homes: String,
    /// Runs of each situation, spread over the homes. Without it 50, and 1,000 with --worn.
    #[arg(long)]
    runs: Option<u64>,
    /// Number of the first seed.
    #[arg(long, default_value_t = 1)]
    first: u64,
    /// What is tried, separated by commas: `map` (the robot knows the home and its pose in it), `lifted` (it is lifted from its
    /// work and put elsewhere), `anywhere` (it knows nothing and has never been on the dock).
    #[arg(long, default_value = "map,lifted,anywhere")]
    situations: String,
    /// What goes wrong, separated by commas: `beams` (words lost, reflected, ragged lobes), `pushed` (the dock was pushed by 5 cm
    /// and turned by 3 degrees since the map was made), `bad-noise`.
    #[arg(long, default_value = "")]
    faults: String,
    /// Instead: jobs of `systematic` for which one charge is not enough, in a known home.
    #[arg(long)]
    low_battery: bool,
    /// Instead: docks that are dirty, dead, moved, turned, recessed, without power, or with a shoe before them, in homes that are known.
    #[arg(long, conflicts_with = "low_battery")]
    worn: bool,
    /// How many times as fast the pack fills in those.
    #[arg(long, default_value_t = 20.0)]
    charging_speed: f64,
    /// Print one JSON object, with each run.
    #[arg(long)]
    json: bool,
    /// Print the decisions of each run that fails.
    #[arg(long)]
    explain: bool,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let model = RobotModel::by_name("sr8730")?;
    let obstacle = Obstacle::parse(&arguments.faults)?;
    let noise = if obstacle.bad_noise {
        Noise::bad()
    } else {
        Noise::nominal()
    };
    let homes = arguments.homes()?;
    let scene_of = |number: usize| -> anyhow::Result<Scene> {
        let place = homes.get(number).context("a home of the set")?;
        let home = match place {
            DockingHome::Generated(number) => GeneratedHome::number(*number).home(&model)?,
            DockingHome::File(path) => Home::load(Path::new(path), &model)?,
        };
        Ok(Scene::new(Arc::new(home), model.clone(), noise))
    };
    let output = if arguments.worn {
        worn_docks(&arguments, &homes, &model)?
    } else if arguments.low_battery {
        low_batteries(&arguments, homes.len(), scene_of)?
    } else {
        trips_home(&arguments, homes.len(), obstacle, &scene_of)?
    };
    writeln!(io::stdout(), "{output}").context("cannot write to standard output")
}

/// Runs, if nobody says how many; seven wears take more trials for the same.
const USUAL_RUNS: u64 = 50;
const WORN_RUNS: u64 = 1_000;
/// Trials with worn docks that follow each other in one home.
const WEARS_IN_A_HOME: usize = 7;

/// Where a home comes from.
enum DockingHome {
    Generated(u32),
    File(&'static str),
}

/// Homes that are cleaned in minutes.
const SMALL: [&str; 2] = ["homes/furnished-room.toml", "homes/two-room-flat.toml"];

impl Arguments {
    fn homes(&self) -> anyhow::Result<Vec<DockingHome>> {
        if self.homes == "small" {
            return Ok(SMALL.into_iter().map(DockingHome::File).collect());
        }
        let half = Half::named(&self.homes).with_context(|| {
            format!(
                "`{}` is no set of homes: give tuning, report or small",
                self.homes
            )
        })?;
        Ok(half.numbers().map(DockingHome::Generated).collect())
    }

    fn runs(&self) -> u64 {
        let usual = if self.worn { WORN_RUNS } else { USUAL_RUNS };
        self.runs.unwrap_or(usual)
    }

    /// The seeds that fall to a home.
    fn seeds(&self, number: usize, homes: usize) -> impl Iterator<Item = u64> {
        (self.first..self.first + self.runs()).skip(number).step_by(homes)
    }
}

fn trips_home(
    arguments: &Arguments,
    homes: usize,
    obstacle: Obstacle,
    scene_of: &dyn Fn(usize) -> anyhow::Result<Scene>,
) -> anyhow::Result<String> {
    let situations = DockingStart::list(&arguments.situations)?;
    let progress = Progress::new("docking");
    let count = situations.len() as f64 * arguments.runs() as f64;
    let mut runs = Vec::new();
    for number in (0..homes).take(arguments.runs() as usize) {
        let scene = scene_of(number)?;
        for seed in arguments.seeds(number, homes) {
            for situation in &situations {
                let run = DockingRun::of(&scene, *situation, seed, obstacle);
                if arguments.explain && !run.docked {
                    run.explain()?;
                }
                runs.push(run);
                progress.show(runs.len() as f64 / count);
            }
        }
    }
    progress.clear();
    let table = DockingTable::of(&runs, &situations);
    Ok(if arguments.json {
        serde_json::json!({
            "homes": arguments.homes,
            "faults": arguments.faults,
            "situations": table,
            "runs": runs,
        })
        .to_string()
    } else {
        table.to_string()
    })
}

fn worn_docks(arguments: &Arguments, homes: &[DockingHome], model: &RobotModel) -> anyhow::Result<String> {
    let progress = Progress::new("worn docks");
    let mut trials = Vec::new();
    for number in arguments.first..arguments.first + arguments.runs() {
        let index = usize::try_from(number)? / WEARS_IN_A_HOME % homes.len();
        let home = homes.get(index).context("a home of the set")?;
        let trial = WornTrial::of(number, home, model)?;
        if arguments.explain {
            trial.explain()?;
        }
        trials.push(trial);
        progress.show(trials.len() as f64 / arguments.runs() as f64);
    }
    progress.clear();
    let summary = WornSummary::of(&trials);
    Ok(if arguments.json {
        let mut object = serde_json::to_value(&summary)?;
        object["runs"] = serde_json::to_value(&trials)?;
        object.to_string()
    } else {
        summary.to_string()
    })
}

fn low_batteries(
    arguments: &Arguments,
    homes: usize,
    scene_of: impl Fn(usize) -> anyhow::Result<Scene>,
) -> anyhow::Result<String> {
    let progress = Progress::new("low battery");
    let mut jobs = Vec::new();
    for number in (0..homes).take(arguments.runs() as usize) {
        let scene = scene_of(number)?;
        for seed in arguments.seeds(number, homes) {
            let done = jobs.len() as f64;
            jobs.push(JobOutcome::of(&scene, seed, arguments.charging_speed, |share| {
                progress.show((done + share) / arguments.runs() as f64);
            }));
        }
    }
    progress.clear();
    let summary = JobsSummary::of(&jobs);
    Ok(if arguments.json {
        serde_json::json!({ "homes": arguments.homes, "low_battery": summary, "runs": jobs }).to_string()
    } else {
        summary.to_string()
    })
}
