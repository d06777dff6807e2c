//! `bench-flood`: 750,000 edges a second on the receive pin while the real firmware drives in the emulated chip.
//! `cargo xtask bench flood` builds and runs it.
#![forbid(unsafe_code)]

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use rayon::prelude::*;
use trials::flood::{FloodResult, flood};
use trials::{CampaignError, Fixture, conclude};

/// Floods the receive pin of a firmware.
#[derive(Debug, Parser)]
#[command(args_override_self = true)]
struct Arguments {
    /// The firmware, as ELF.
    #[arg(long)]
    firmware: PathBuf,
    /// Floods, each at another phase.
    #[arg(long, default_value_t = 4)]
    count: u64,
    /// How long each lasts: at least 4, so that whole seconds are reported.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u64).range(4..=3_600))]
    seconds: u64,
    /// Print JSON, one object a line.
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    conclude("bench-flood", run(&Arguments::parse()), "a flood did harm")
}

fn run(arguments: &Arguments) -> Result<bool, CampaignError> {
    let fixture = Fixture::open(&arguments.firmware)?.with_drawn_robots();
    let seeds: Vec<u64> = (1..=arguments.count).collect();
    let floods: Vec<FloodResult> = seeds
        .par_iter()
        .map(|seed| flood(&fixture, *seed, arguments.seconds))
        .collect::<Result<_, _>>()?;
    let mut out = io::stdout().lock();
    for result in &floods {
        tell(&mut out, arguments, result)?;
    }
    Ok(!floods.is_empty() && floods.iter().all(FloodResult::is_good))
}

fn tell(out: &mut impl Write, arguments: &Arguments, result: &FloodResult) -> io::Result<()> {
    if arguments.json {
        serde_json::to_writer(&mut *out, result).map_err(io::Error::from)?;
        return writeln!(out);
    }
    let number = |value: Option<u64>| value.map_or_else(|| "never".to_owned(), |value| value.to_string());
    writeln!(
        out,
        "{:>3} {:>4} s  wheels off {:>3} ms  loop {} Hz, before {}  resets {}  breaches {}  drives again after {} ms{}",
        result.seed,
        result.seconds,
        result.wheels_off_ms,
        number(result.steps_hz.map(u64::from)),
        result.steps_before_hz,
        result.resets,
        result.violations,
        number(result.recovered_ms),
        if result.is_good() { "" } else { "  WRONG" },
    )?;
    out.flush()
}
