//! `bench-lifted`: how soon and how reliably a robot relocalizes that was lifted from its work and put down
//! elsewhere in the home. `cargo xtask bench lifted` builds and runs it.
#![forbid(unsafe_code)]

#[path = "../bench-docking/place.rs"]
mod place;
#[path = "../../progress.rs"]
mod progress;
mod table;
mod trial;

use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

use anyhow::Context;
use clap::Parser;
use home::generate::{GeneratedHome, Half};
use home::{Home, Noise, RobotModel};
use rvac_sim::Scene;

use progress::Progress;
use table::LiftedTable;
use trial::{LiftedTrial, Preparation, RadioFitted};

/// Measures how a lifted robot finds itself in generated homes.
#[derive(Debug, Parser)]
struct Arguments {
    /// Homes: `tuning` or `report` (odd and even numbers of the published set), or a home's file.
    #[arg(long, default_value = "report")]
    homes: String,
    /// Homes of the set that are used, from its first one on.
    #[arg(long, default_value_t = 25)]
    first: usize,
    /// Trials in each home.
    #[arg(long, default_value_t = 4)]
    seeds: u64,
    /// Time that the robot has cleaned a known home before it is lifted, minutes.
    #[arg(long, default_value_t = 15)]
    minutes: u64,
    /// `good`, `nominal` or `bad`.
    #[arg(long, default_value = "nominal")]
    noise: String,
    /// Radio beacons in the home of which the robot measures the strength; none otherwise.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=8))]
    beacons: u8,
    /// Print one JSON object, with each trial.
    #[arg(long)]
    json: bool,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let homes = arguments.homes()?;
    let progress = Progress::new("lifting");
    let count = homes.len() as f64 * arguments.seeds as f64;
    let work = Preparation {
        minutes: arguments.minutes,
        radio: match arguments.beacons {
            0 => RadioFitted::Absent,
            beacons => RadioFitted::Strengths(beacons),
        },
    };
    let mut trials = Vec::new();
    for scene in &homes {
        for seed in 1..=arguments.seeds {
            trials.push(LiftedTrial::of(scene, seed, work));
            progress.show(trials.len() as f64 / count);
        }
    }
    progress.clear();
    let table = LiftedTable::of(&trials);
    let output = if arguments.json {
        serde_json::json!({ "homes": arguments.homes, "summary": table, "trials": trials }).to_string()
    } else {
        table.to_string()
    };
    writeln!(io::stdout(), "{output}").context("cannot write to standard output")
}

impl Arguments {
    fn homes(&self) -> anyhow::Result<Vec<Scene>> {
        let model = RobotModel::by_name("sr8730")?;
        let noise: Noise = self.noise.parse()?;
        let Some(half) = Half::named(&self.homes) else {
            let home = Home::load(Path::new(&self.homes), &model)?;
            return Ok(vec![Scene::new(Arc::new(home), model, noise)]);
        };
        half.numbers()
            .take(self.first)
            .map(|number| {
                let home = GeneratedHome::number(number).home(&model)?;
                Ok(Scene::new(Arc::new(home), model.clone(), noise))
            })
            .collect()
    }
}
