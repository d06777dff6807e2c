//! `bench-firmware`: how much of its chip the robot's real firmware uses, in the emulator: the main loop's pace, interrupts, the
//! serial line by software, the stack; and how fast the emulator is. `cargo xtask bench firmware` builds and runs it.
#![forbid(unsafe_code)]

mod desk;
mod measure;
mod profile;
mod report;

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use measure::MeasurementPlan;

/// Measures a firmware in the emulated chip.
#[derive(Debug, Parser)]
struct Arguments {
    /// The firmware, as ELF.
    #[arg(long)]
    firmware: PathBuf,
    /// The same firmware built with a main loop that does not sleep (`--features free-running`).
    #[arg(long)]
    free_running: PathBuf,
    /// Floor plan.
    #[arg(long)]
    home: PathBuf,
    /// Simulated seconds at full load of the serial line, in both directions, at 230,400 baud.
    #[arg(long, default_value_t = 60, value_parser = clap::value_parser!(u64).range(1..=86_400))]
    flood_seconds: u64,
    /// Only report in which functions the chip spends its time: standing, driving, and at full load of the serial line.
    #[arg(long, conflicts_with = "json")]
    profile: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let plan = MeasurementPlan {
        firmware: arguments.firmware,
        free_running: arguments.free_running,
        home: arguments.home,
        flood_ms: arguments.flood_seconds * 1_000,
    };
    if arguments.profile {
        return match measure::profile(&plan) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => complain(&format!("{error:#}")),
        };
    }
    match measure::measure(&plan).and_then(|report| report.print(arguments.json).map(|()| report)) {
        Ok(report) if report.faults().is_empty() => ExitCode::SUCCESS,
        Ok(report) => complain(&report.faults().join("; ")),
        Err(error) => complain(&format!("{error:#}")),
    }
}

fn complain(what: &str) -> ExitCode {
    // If standard error is closed, the message is lost.
    writeln!(io::stderr(), "bench-firmware: {what}").ok();
    ExitCode::FAILURE
}
