//! `bench-docking`: how surely, how fast and how exactly the robot comes home. `cargo xtask bench docking` builds and runs it.
#![forbid(unsafe_code)]

mod place;
#[path = "../../progress.rs"]
mod progress;
mod run;
mod table;

use std::io::{self, Write};
use std::sync::Arc;

use anyhow::Context;
use clap::Parser;
use home::generate::{GeneratedHome, PUBLISHED};
use home::{Noise, RobotModel};
use rvac_sim::Scene;

use progress::Progress;
use run::{Obstacle, Run, Situation};
use table::Table;

/// Measures docking in generated homes.
#[derive(Debug, Parser)]
struct Arguments {
    /// Homes: `tune` or `report` (odd and even numbers of the published set).
    #[arg(long, default_value = "report")]
    homes: String,
    /// Runs of each situation, spread over the homes.
    #[arg(long, default_value_t = 50)]
    runs: u64,
    /// Number of the first seed.
    #[arg(long, default_value_t = 1)]
    first: u64,
    /// What is tried, separated by commas: `map` (the robot knows the home and its place in it), `lifted` (it is lifted from its
    /// work and put elsewhere), `anywhere` (it knows nothing and has never been on the dock).
    #[arg(long, default_value = "map,lifted,anywhere")]
    situations: String,
    /// What goes wrong, separated by commas: `beams` (words lost, reflected, ragged lobes), `pushed` (the dock was pushed by 5 cm
    /// and turned by 3 degrees since the map was made), `bad-noise`.
    #[arg(long, default_value = "")]
    faults: String,
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
    let situations = Situation::list(&arguments.situations)?;
    let homes: Vec<u32> = match arguments.homes.as_str() {
        "tune" => PUBLISHED.filter(|number| number % 2 == 1).collect(),
        "report" => PUBLISHED.filter(|number| number % 2 == 0).collect(),
        other => anyhow::bail!("`{other}` is no set of homes: give tune or report"),
    };
    let progress = Progress::new("docking");
    let mut runs = Vec::new();
    let count = situations.len() as f64 * arguments.runs as f64;
    for number in (0..homes.len()).take(arguments.runs as usize) {
        let home = homes.get(number).context("a home of the set")?;
        let scene = Scene::new(
            Arc::new(GeneratedHome::number(*home).home(&model)?),
            model.clone(),
            noise,
        );
        let seeds = (arguments.first..arguments.first + arguments.runs)
            .skip(number)
            .step_by(homes.len());
        for seed in seeds {
            for situation in &situations {
                let run = Run::of(&scene, (*situation, seed), obstacle);
                if arguments.explain && !run.docked {
                    run.explain()?;
                }
                runs.push(run);
                progress.show(runs.len() as f64 / count);
            }
        }
    }
    progress.clear();
    let table = Table::of(&runs, &situations);
    let mut out = io::stdout().lock();
    if arguments.json {
        let object = serde_json::json!({
            "homes": arguments.homes,
            "faults": arguments.faults,
            "situations": table,
            "runs": runs,
        });
        writeln!(out, "{object}")?;
    } else {
        writeln!(out, "{table}")?;
    }
    Ok(())
}
