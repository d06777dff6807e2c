//! `bench-flash`: firmware goes into the simulated chips of both robots and comes back, with cut power and killed programmers.
//! `cargo xtask test flash` builds and runs it.
#![forbid(unsafe_code)]

mod openocd_campaign;
mod pic32_campaign;
mod relax_campaign;

use std::io::{self, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use flash_trials::{emulated_update, update_cuts};
use serde::Serialize;

/// Flashes simulated chips.
#[derive(Debug, Parser)]
#[command(args_override_self = true)]
struct Arguments {
    /// Random moments at which power is cut or the programmer killed, on each chip.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    moments: u32,
    /// Seed of the moments.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The SR8730's firmware, as ELF: it is written into the emulated chip and must run there.
    #[arg(long)]
    firmware: Option<PathBuf>,
    /// The program stcgal, which writes the simulated loader on a pseudo terminal.
    #[arg(long)]
    stcgal: Option<PathBuf>,
    /// The program OpenOCD, which halts, reads and writes the emulated chip through its test port.
    #[arg(long)]
    openocd: Option<PathBuf>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// What came of it.
#[derive(Debug, Default, Serialize)]
struct FlashReport {
    /// Backup, write, verify and restore of a chip.
    round_trips: u32,
    /// Those after which the chip held the same bytes.
    round_trips_identical: u32,
    /// Runs that were cut off.
    power_cuts: u32,
    /// Chips that the next run did not bring back.
    bricked: u32,
    /// Updates that were cut off, at each step with a modelled chip and while the emulated one was read or written.
    update_cuts: u32,
    /// Those after which programs or robot did not run, or were of different updates, or took no further update.
    update_cuts_bad: u32,
    /// Whether the real firmware ran after it was written; absent when none was given.
    firmware_runs: Option<bool>,
    /// Whether stcgal wrote the simulated loader; absent when it was not given.
    stcgal_programmed: Option<bool>,
    /// Whether OpenOCD read and wrote the emulated chip; absent when it was not given.
    openocd_programmed: Option<bool>,
    /// Whether our flasher did so on the same terminal.
    own_flasher_programmed: bool,
    /// 256 KiB with a clock of 1 MHz, seconds.
    write_256_kib_s: f64,
    verify_256_kib_s: f64,
    /// Four clocks for each bit.
    wire_limit_s: f64,
    write_over_limit: f64,
}

impl FlashReport {
    fn is_good(&self) -> bool {
        self.round_trips_identical == self.round_trips
            && self.bricked == 0
            && self.update_cuts_bad == 0
            && self.firmware_runs != Some(false)
            && self.stcgal_programmed != Some(false)
            && self.openocd_programmed != Some(false)
            && self.own_flasher_programmed
            && self.write_over_limit <= OVER_LIMIT_MAX
    }
}

/// The time to write may be so much longer than the wire alone takes.
const OVER_LIMIT_MAX: f64 = 1.3;

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            writeln!(io::stderr(), "bench-flash: {error:#}").ok();
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> anyhow::Result<bool> {
    let mut report = FlashReport::default();
    if let Some(openocd) = &arguments.openocd {
        report.openocd_programmed = Some(openocd_campaign::openocd_agrees(openocd)?);
    }
    pic32_campaign::round_trip(&mut report)?;
    pic32_campaign::pace(&mut report)?;
    pic32_campaign::cuts((arguments.moments, arguments.seed), &mut report)?;
    if let Some(elf) = &arguments.firmware {
        report.firmware_runs = Some(pic32_campaign::firmware_runs(elf)?);
    }
    relax_campaign::round_trip(&mut report)?;
    relax_campaign::cuts((arguments.moments, arguments.seed), &mut report)?;
    let modelled = update_cuts::cut_everywhere()?;
    // Each takes seconds: two readings, a write and a way back.
    let emulated = emulated_update::update_emulated(arguments.moments.div_ceil(5), arguments.seed)?;
    for cuts in [modelled, emulated] {
        report.update_cuts += cuts.cut;
        report.update_cuts_bad += cuts.broken + cuts.mixed + cuts.stuck;
    }
    report.own_flasher_programmed = relax_campaign::own_flasher_programs()?;
    if let Some(stcgal) = &arguments.stcgal {
        report.stcgal_programmed = Some(relax_campaign::stcgal_programs(stcgal)?);
    }
    let text = match arguments.json {
        true => serde_json::to_string(&report)?,
        false => described(&report),
    };
    writeln!(io::stdout(), "{text}")?;
    Ok(report.is_good())
}

fn described(report: &FlashReport) -> String {
    let tried = |outcome: Option<bool>| match outcome {
        Some(true) => "yes",
        Some(false) => "NO",
        None => "not tried",
    };
    format!(
        "round trips {}, identical {}\ncut off {}, bricked {}\nupdates cut off {}, bad ends {}\n256 KiB at 1 MHz: written in {:.2} s, verified in {:.2} s; the \
         wire alone takes {:.2} s (x {:.2})\nthe real firmware runs: {}\nour flasher writes on a terminal: {}\nstcgal writes on \
         the same terminal: {}\nOpenOCD reads and writes the chip: {}",
        report.round_trips,
        report.round_trips_identical,
        report.power_cuts,
        report.bricked,
        report.update_cuts,
        report.update_cuts_bad,
        report.write_256_kib_s,
        report.verify_256_kib_s,
        report.wire_limit_s,
        report.write_over_limit,
        tried(report.firmware_runs),
        tried(Some(report.own_flasher_programmed)),
        tried(report.stcgal_programmed),
        tried(report.openocd_programmed),
    )
}
