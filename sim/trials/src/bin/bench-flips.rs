//! `bench-flips`: bits that flip in the memory and the registers of the emulated chip while it runs the real firmware.
//! `cargo xtask bench flips` builds and runs it.
#![forbid(unsafe_code)]

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use trials::flips::{BitStorage, Breach, Fate, FlipPlan, FlipTally, flip_bits};
use trials::{CampaignError, Fixture, conclude};

/// Flips bits of a firmware's memory.
#[derive(Debug, Parser)]
struct Arguments {
    /// The firmware, as ELF.
    #[arg(long)]
    firmware: PathBuf,
    /// Flips.
    #[arg(long, default_value_t = 10_000)]
    count: u32,
    /// Seed of places and moments.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Stretches of life, for each of the five situations, that the flips are spread over.
    #[arg(long, default_value_t = 8)]
    courses: usize,
    /// Flips in flash that are left until the check of the image must have found them.
    #[arg(long, default_value_t = 20)]
    image_checks: u32,
    /// Tell each course on standard error.
    #[arg(long)]
    progress: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    conclude(
        "bench-flips",
        run(&Arguments::parse()),
        "a flipped bit was unsafe, or not what was foreseen",
    )
}

fn run(arguments: &Arguments) -> Result<bool, CampaignError> {
    let fixture = Fixture::open(&arguments.firmware)?;
    let plan = FlipPlan {
        count: arguments.count,
        seed: arguments.seed,
        courses: arguments.courses,
        image_checks: arguments.image_checks,
    };
    let mut shown_breaches = 0;
    let tally = flip_bits(&fixture, &plan, |tally| {
        if arguments.progress {
            let (flips, tried) = (tally.flips, tally.tried);
            writeln!(io::stderr(), "{flips} flips, {tried} tried").ok();
            tell_breaches(
                &mut io::stderr(),
                tally.breaches.get(shown_breaches..).unwrap_or_default(),
            )
            .ok();
            shown_breaches = tally.breaches.len();
        }
    })?;
    let mut out = io::stdout().lock();
    if arguments.json {
        serde_json::to_writer(&mut out, &tally).map_err(io::Error::from)?;
        writeln!(out)?;
    } else {
        print(&mut out, &tally)?;
    }
    Ok(tally.is_safe())
}

fn print(out: &mut impl Write, tally: &FlipTally) -> io::Result<()> {
    let row = |fates: &std::collections::BTreeMap<Fate, u32>| -> String {
        let number = |fate| fates.get(fate).copied().unwrap_or_default();
        Fate::ALL
            .iter()
            .map(|fate| format!("{:>12}", number(fate)))
            .collect()
    };
    let names: String = Fate::ALL
        .iter()
        .map(|fate| format!("{:>12}", format!("{fate:?}").to_lowercase()))
        .collect();
    writeln!(out, "{:<16}{names}", "")?;
    for storage in BitStorage::ALL {
        if let Some(fates) = tally.fates.get(&storage) {
            writeln!(out, "{:<16}{}", storage.name(), row(fates))?;
        }
    }
    for (situation, fates) in &tally.situations {
        writeln!(out, "{:<16}{}", situation.name(), row(fates))?;
    }
    let (checked, wrong) = tally.foreseen_checked;
    writeln!(
        out,
        "{} flips, {} of them tried; {checked} tried though foreseen, {wrong} of them otherwise; \
         {} left to the image check, {} of them in \
         start-up code that starts over and over with all off, {} not found",
        tally.flips,
        tally.tried,
        tally.image_checked,
        tally.starting_over.len(),
        tally.image_missed.len()
    )?;
    for unreported in tally.starting_over.iter().chain(&tally.image_missed) {
        writeln!(
            out,
            "not reported: {:?} in {}; {} resets, motors and charger {}",
            unreported.place,
            unreported.name,
            unreported.resets,
            if unreported.is_off { "off" } else { "on" }
        )?;
    }
    tell_breaches(out, &tally.breaches)
}

fn tell_breaches(out: &mut impl Write, breaches: &[Breach]) -> io::Result<()> {
    for breach in breaches {
        writeln!(
            out,
            "{:?} for {} ms: {} course {} at {} ms, {:?} in {}: {}",
            breach.fate,
            breach.broken_ms,
            breach.situation.name(),
            breach.course,
            breach.at_ms,
            breach.place,
            breach.name,
            breach.breach
        )?;
    }
    Ok(())
}
