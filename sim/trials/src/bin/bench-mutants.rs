//! `bench-mutants`: boards with one mistake each, and who notices. `cargo xtask bench mutants` builds and runs it.
#![forbid(unsafe_code)]

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use rayon::prelude::*;
use trials::wiring::{Demand, Mistake, Noticed, notice};
use trials::{CampaignError, Fixture, Trial, conclude, trials};

/// Share of the mistakes that must be noticed.
const NOTICED_SHARE: f64 = 0.95;

/// Puts a firmware into boards with one mistake each.
#[derive(Debug, Parser)]
#[command(args_override_self = true)]
struct Arguments {
    /// The firmware, as ELF.
    #[arg(long)]
    firmware: PathBuf,
    /// Seed of the moments at which each trial's event happens.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only mistakes whose name contains this.
    #[arg(long)]
    only: Option<String>,
    /// This trial in place of those that can notice the mistake; may be given several times.
    #[arg(long)]
    trial: Vec<String>,
    /// All trials, those that can notice the mistake first.
    #[arg(long)]
    every_trial: bool,
    /// Print JSON, one object a line.
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    conclude(
        "bench-mutants",
        run(&Arguments::parse()),
        "too many mistakes were not noticed, or a deviation was not stood",
    )
}

fn run(arguments: &Arguments) -> Result<bool, CampaignError> {
    let begun = Instant::now();
    let fixture = Fixture::open(&arguments.firmware)?;
    let all = trials();
    let is_asked = |mistake: &Mistake| {
        arguments
            .only
            .as_ref()
            .is_none_or(|part| mistake.name().contains(part))
    };
    let mistakes: Vec<Mistake> = Mistake::all().into_iter().filter(is_asked).collect();
    let results: Vec<Noticed> = mistakes
        .par_iter()
        .map(|mistake| {
            let result = notice(
                &fixture,
                mistake,
                &chosen(arguments, &all, mistake),
                arguments.seed,
            );
            tell(arguments, &result).map(|()| result)
        })
        .collect::<Result<_, _>>()?;
    let count = |demand: Demand, good: bool| {
        let those = results.iter().filter(|result| result.demand == demand);
        those.filter(|result| result.is_good() == good).count()
    };
    let (noticed, survivors) = (count(Demand::Noticed, true), count(Demand::Noticed, false));
    let (stood, not_stood) = (count(Demand::Stood, true), count(Demand::Stood, false));
    let made = noticed + survivors;
    let mut out = io::stdout().lock();
    if arguments.json {
        let sum = serde_json::json!({
            "made": made, "noticed": noticed, "survivors": survivors, "deviations": stood + not_stood, "stood": stood,
            "seconds": begun.elapsed().as_secs(),
        });
        writeln!(out, "{sum}")?;
    } else {
        writeln!(
            out,
            "{noticed} of {made} mistakes were noticed, {stood} of {} deviations stood, in {} s",
            stood + not_stood,
            begun.elapsed().as_secs()
        )?;
    }
    let enough = noticed as f64 >= NOTICED_SHARE * made as f64;
    Ok(!results.is_empty() && enough && not_stood == 0)
}

fn chosen(arguments: &Arguments, all: &[Trial], mistake: &Mistake) -> Vec<Trial> {
    let noticers = mistake.noticers();
    let of_name = |name: &&str| all.iter().find(|trial| trial.name == *name).copied();
    if !arguments.trial.is_empty() {
        let names = arguments.trial.iter().map(String::as_str);
        return names.filter_map(|name| of_name(&name)).collect();
    }
    let mut chosen: Vec<Trial> = noticers.iter().filter_map(of_name).collect();
    if arguments.every_trial {
        let rest = all.iter().filter(|trial| !noticers.contains(&trial.name));
        chosen.extend(rest.copied());
    }
    chosen
}

fn tell(arguments: &Arguments, result: &Noticed) -> io::Result<()> {
    let mut out = io::stdout().lock();
    if arguments.json {
        serde_json::to_writer(&mut out, result).map_err(io::Error::from)?;
        return writeln!(out);
    }
    let by = result.by.as_deref().unwrap_or("NOBODY");
    let remark = match (result.demand, result.is_good()) {
        (Demand::Noticed, _) => "",
        (Demand::Stood, true) => ", as it must be",
        (Demand::Stood, false) => ", though it must be stood",
    };
    writeln!(out, "{:<56} {by}{remark}", result.mistake)
}
