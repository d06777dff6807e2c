//! `bench-charges`: the real firmware in the emulated chip begins to charge packs of many kinds, and meets trouble.
//! `cargo xtask bench charges` builds and runs it.
#![forbid(unsafe_code)]

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use rayon::prelude::*;
use trials::charges::{ChargeResult, charge};
use trials::{CampaignError, Fixture, conclude};

/// Charges packs with a firmware.
#[derive(Debug, Parser)]
struct Arguments {
    /// The firmware, as ELF.
    #[arg(long)]
    firmware: PathBuf,
    /// Charges.
    #[arg(long, default_value_t = 14)]
    count: u64,
    /// Seed of the first one; the others follow.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Print JSON, one object a line.
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    conclude(
        "bench-charges",
        run(&Arguments::parse()),
        "a charge was not as it must be",
    )
}

fn run(arguments: &Arguments) -> Result<bool, CampaignError> {
    let fixture = Fixture::open(&arguments.firmware)?.with_drawn_robots();
    let mut out = io::stdout().lock();
    let mut all_good = arguments.count > 0;
    let seeds: Vec<u64> = (arguments.seed..arguments.seed + arguments.count).collect();
    for seeds in seeds.chunks(rayon::current_num_threads()) {
        let charges = seeds.par_iter().map(|seed| charge(&fixture, *seed));
        for charge in charges.collect::<Result<Vec<_>, _>>()? {
            all_good &= charge.is_good();
            tell(&mut out, arguments, &charge)?;
        }
    }
    Ok(all_good)
}

fn tell(out: &mut impl Write, arguments: &Arguments, charge: &ChargeResult) -> io::Result<()> {
    if arguments.json {
        serde_json::to_writer(&mut *out, charge).map_err(io::Error::from)?;
        return writeln!(out);
    }
    let ended = charge.ended_ms.map_or_else(String::new, |ms| format!("{ms} ms"));
    writeln!(
        out,
        "{:>5} {:<18} {:.2} Ah  {:>5.2} A  {:>5.1} C  {ended:>9}  {} breaches{}{}",
        charge.seed,
        format!("{:?}", charge.disturbance),
        charge.capacity_ah,
        charge.highest_a,
        charge.hottest_c,
        charge.violations,
        if charge.began { "" } else { "  refused" },
        if charge.is_good() { "" } else { "  WRONG" },
    )?;
    out.flush()
}
