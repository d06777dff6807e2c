//! `bench-floors`: how surely a robot that was put down somewhere finds out on which floor it is. `cargo xtask bench floors`
//! builds and runs it.
//!
//! Each home is a floor. The robot first learns it on a run from its dock; then it is put down anywhere, by a host that keeps
//! the maps of three floors, and starts to clean.
#![forbid(unsafe_code)]

#[path = "../bench-docking/place.rs"]
mod place;
#[path = "../../progress.rs"]
mod progress;
mod table;
mod trial;

use std::io::{self, Write};
use std::sync::Arc;

use anyhow::Context;
use clap::Parser;
use home::generate::{GeneratedHome, Half};
use home::{Noise, RobotModel};
use rvac_sim::Scene;

use progress::Progress;
use table::FloorsTable;
use trial::{FloorsTrial, HostMemory, MappedFloor};

/// Measures the recognition of floors in generated homes.
#[derive(Debug, Parser)]
struct Arguments {
    /// Homes: `tuning` or `report` (odd and even numbers of the published set).
    #[arg(long, default_value = "report")]
    homes: String,
    /// Homes of the set that are used, from its first one on.
    #[arg(long, default_value_t = 25)]
    first: usize,
    /// Trials of each kind on each floor.
    #[arg(long, default_value_t = 2)]
    seeds: u64,
    /// Longest run on which a floor is learnt, minutes.
    #[arg(long, default_value_t = 60)]
    minutes: u64,
    /// `good`, `nominal` or `bad`.
    #[arg(long, default_value = "nominal")]
    noise: String,
    /// Print one JSON object, with each trial.
    #[arg(long)]
    json: bool,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let floors = arguments.floors()?;
    let progress = Progress::new("floors");
    let mut trials = Vec::new();
    let count = floors.len() as f64 * arguments.seeds as f64;
    for number in 0..floors.len() {
        for seed in 1..=arguments.seeds {
            for kept in HostMemory::ALL {
                trials.extend(FloorsTrial::of(&floors, number, (kept, seed)));
            }
            progress.show((number as f64 * arguments.seeds as f64 + seed as f64) / count);
        }
    }
    progress.clear();
    let table = FloorsTable::of(&trials);
    let output = if arguments.json {
        serde_json::json!({ "homes": arguments.homes, "summary": table, "trials": trials }).to_string()
    } else {
        table.to_string()
    };
    writeln!(io::stdout(), "{output}").context("cannot write to standard output")
}

impl Arguments {
    fn floors(&self) -> anyhow::Result<Vec<MappedFloor>> {
        let half = Half::named(&self.homes)
            .with_context(|| format!("`{}` is no set of homes: give tuning or report", self.homes))?;
        let model = RobotModel::by_name("sr8730")?;
        let noise: Noise = self.noise.parse()?;
        let numbers: Vec<u32> = half.numbers().take(self.first).collect();
        let progress = Progress::new("learning");
        let mut floors = Vec::new();
        for number in &numbers {
            let home = GeneratedHome::number(*number).home(&model)?;
            let scene = Scene::new(Arc::new(home), model.clone(), noise);
            floors.push(MappedFloor::learnt(scene, u64::from(*number), self.minutes)?);
            progress.show(floors.len() as f64 / numbers.len() as f64);
        }
        progress.clear();
        Ok(floors)
    }
}
