//! `bench-board`: draws faults of clocks, time zones, disks, cables, gyros and gamepads, and judges what people are told of each; with `--log-hours` it counts
//! what the log says in so many hours.
#![forbid(unsafe_code)]

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use rvac_sim::board_faults::{BoardFigures, campaign};
use rvac_sim::log_pace::{LogFigures, log_figures};
use rvac_sim::{CalibrationChoice, GyroFitted, Scene, SceneSettings};
use serde::Serialize;

/// Draws faults around the Linux board.
#[derive(Debug, Parser)]
struct Arguments {
    /// So many faults.
    #[arg(long, default_value_t = 200)]
    seeds: u64,
    /// The home.
    #[arg(long, default_value = "homes/two-room-flat.toml")]
    home: PathBuf,
    /// Read the log of so many hours as well, with a job and an outage in each day.
    #[arg(long, default_value_t = 0)]
    log_hours: u64,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// All that is measured.
#[derive(Debug, Serialize)]
struct Figures {
    #[serde(flatten)]
    board: BoardFigures,
    log: Option<LogFigures>,
}

fn main() -> anyhow::Result<ExitCode> {
    let arguments = Arguments::parse();
    let scene = Scene::load(&SceneSettings {
        home: arguments.home,
        robot: "sr8730".to_owned(),
        noise: "nominal".to_owned(),
        firmware: None,
        record: CalibrationChoice::default(),
        gyro: GyroFitted::default(),
    })?;
    let figures = Figures {
        board: campaign(&scene, arguments.seeds),
        log: (arguments.log_hours > 0).then(|| log_figures(&scene, arguments.log_hours, 1)),
    };
    let mut output = io::stdout().lock();
    if arguments.json {
        writeln!(output, "{}", serde_json::to_string(&figures)?)?;
    } else {
        print(&figures.board, &mut output)?;
        if let Some(log) = &figures.log {
            print_log(log, &mut output)?;
        }
    }
    let repeats = figures.log.is_some_and(|log| !log.again.is_empty());
    Ok(ExitCode::from(u8::from(!figures.board.bad.is_empty() || repeats)))
}

fn print_log(log: &LogFigures, output: &mut impl Write) -> io::Result<()> {
    writeln!(output, "log of {} hours with {} jobs", log.hours, log.jobs)?;
    for (occupation, pace) in &log.paces {
        writeln!(
            output,
            "  {}: {} lines in {:.1} h, {:.0} a day of it",
            occupation.name(),
            pace.lines,
            pace.hours,
            pace.lines_a_day
        )?;
    }
    for repetition in &log.again {
        writeln!(
            output,
            "  again within a minute, {} times: {}",
            repetition.times, repetition.text
        )?;
    }
    Ok(())
}

fn print(figures: &BoardFigures, output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "{} faults: {} untold, {} wrong causes, {} lost changes, {} violations",
        figures.seeds, figures.untold_faults, figures.wrong_causes, figures.lost_changes, figures.violations
    )?;
    for (fault, told_s) in &figures.told_s_max {
        writeln!(output, "  {fault}: told after {told_s:.1} s at most")?;
    }
    for passage in &figures.bad {
        writeln!(output, "  {passage:?}")?;
    }
    Ok(())
}
