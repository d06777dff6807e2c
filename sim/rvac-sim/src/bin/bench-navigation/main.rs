//! `bench-navigation`: how fast and how surely the robot covers homes, against the lower bound and against bounce.
//! `cargo xtask bench navigation` builds and runs it.
#![forbid(unsafe_code)]

mod homes;
#[path = "../../progress.rs"]
mod progress;
mod run;
mod table;
mod traps;

use std::io::{self, Write};

use anyhow::Context;
use clap::Parser;
use home::traps::{Trap, TrapKind};
use home::{Noise, RobotModel};

use homes::Place;
use progress::Progress;
use run::{Mode, Run};
use table::Table;
use traps::{TrapRun, TrapTable};

/// Measures coverage and localization in simulated homes.
#[derive(Debug, Parser)]
struct Arguments {
    /// Homes, separated by commas: `tuning` and `report` (odd and even numbers of the published set), `published` (both),
    /// `generated:A..B` with B, `generated:N`, `trap:KIND/SEED`, or files.
    #[arg(
        long,
        default_value = "homes/furnished-room.toml,homes/two-room-flat.toml,generated:2..10"
    )]
    homes: String,
    /// Measure in drawn traps of every kind instead of homes: whether the robot comes free, and whether it ends. Takes --seeds,
    /// --noise, --modes.
    #[arg(long)]
    traps: bool,
    /// Seeds of each home: 1 to this.
    #[arg(long, default_value_t = 2)]
    seeds: u64,
    /// Noise class: ideal, good, nominal or bad.
    #[arg(long, default_value = "nominal")]
    noise: String,
    /// What is compared, separated by commas: `bounce`, `known-map` (systematic with a perfect map),
    /// `old-map` (the same with the map of the first day of a home like generated:7/2+people), `first-run` (systematic
    /// without), `perfect-pose` (with perfect map and pose: what the planner can do).
    #[arg(long, default_value = "bounce,known-map,first-run")]
    modes: String,
    /// Most T0 that a run may take.
    #[arg(long, default_value_t = 10.0)]
    longest: f64,
    /// Print one JSON object, with the figures of each run.
    #[arg(long)]
    json: bool,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let model = RobotModel::by_name("sr8730")?;
    let noise = Noise::by_name(&arguments.noise)
        .with_context(|| format!("there is no noise class `{}`", arguments.noise))?;
    let modes = Mode::list(&arguments.modes)?;
    if arguments.traps {
        return measure_traps(&arguments, (&model, noise), &modes);
    }
    let places = Place::list(&arguments.homes)?;
    let count = places.len() as f64 * modes.len() as f64 * arguments.seeds as f64;
    let progress = Progress::new("navigation");
    let mut runs = Vec::new();
    for place in &places {
        let scene = place.scene(&model, noise)?;
        let first_day = place.first_day(&model)?;
        for mode in &modes {
            for seed in 1..=arguments.seeds {
                let done = runs.len() as f64;
                let run = Run::of((&scene, &first_day), (*mode, seed), arguments.longest, |share| {
                    progress.show((done + share) / count);
                });
                runs.push(run);
            }
        }
    }
    progress.clear();
    let table = Table::of(&runs, &modes);
    let mut out = io::stdout().lock();
    if arguments.json {
        let object = serde_json::json!({
            "homes": arguments.homes,
            "seeds": arguments.seeds,
            "noise": arguments.noise,
            "longest_over_t0": arguments.longest,
            "modes": table,
            "runs": runs,
        });
        writeln!(out, "{object}")?;
    } else {
        writeln!(
            out,
            "{} homes, {} seeds, noise {}: median (90th percentile)\n{table}",
            places.len(),
            arguments.seeds,
            arguments.noise
        )?;
    }
    Ok(())
}

fn measure_traps(
    arguments: &Arguments,
    (model, noise): (&RobotModel, Noise),
    modes: &[Mode],
) -> anyhow::Result<()> {
    let progress = Progress::new("traps");
    let count = TrapKind::ALL.len() as f64 * modes.len() as f64 * arguments.seeds as f64;
    let mut runs = Vec::new();
    for kind in TrapKind::ALL {
        for mode in modes {
            for seed in 1..=arguments.seeds {
                let trap = Trap {
                    kind: *kind,
                    seed: u32::try_from(seed)?,
                };
                runs.push(TrapRun::of(trap, model, (noise, *mode))?);
                progress.show(runs.len() as f64 / count);
            }
        }
    }
    progress.clear();
    let table = TrapTable::of(&runs, modes);
    let mut out = io::stdout().lock();
    if arguments.json {
        let object = serde_json::json!({
            "seeds": arguments.seeds,
            "noise": arguments.noise,
            "traps": table.json(),
            "runs": runs,
        });
        writeln!(out, "{object}")?;
    } else {
        writeln!(
            out,
            "{} kinds of traps, {} seeds, noise {}\n{table}",
            TrapKind::ALL.len(),
            arguments.seeds,
            arguments.noise
        )?;
    }
    Ok(())
}
