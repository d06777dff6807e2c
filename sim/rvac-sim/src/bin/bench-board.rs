//! `bench-board`: draws faults of clocks, disks, cables and gyros, and judges what people are told of each.
#![forbid(unsafe_code)]

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use rvac_sim::board_faults::{BoardFigures, campaign};
use rvac_sim::{CalibrationChoice, GyroFitted, Scene, SceneSettings};

/// Draws faults around the Linux board.
#[derive(Debug, Parser)]
struct Arguments {
    /// So many faults.
    #[arg(long, default_value_t = 90)]
    seeds: u64,
    /// The home.
    #[arg(long, default_value = "homes/two-room-flat.toml")]
    home: PathBuf,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
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
    let figures = campaign(&scene, arguments.seeds);
    let mut output = io::stdout().lock();
    if arguments.json {
        writeln!(output, "{}", serde_json::to_string(&figures)?)?;
    } else {
        print(&figures, &mut output)?;
    }
    Ok(ExitCode::from(u8::from(!figures.bad.is_empty())))
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
