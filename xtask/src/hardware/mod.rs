//! `cargo xtask hardware`: checks our circuit boards and makes from them what a board maker and a reader need.
//!
//! The boards are KiCad 6 projects in `hardware/`. What that KiCad can do without a window (fill zones, check design rules, write
//! Gerber files) its own Python does; electrical rules, and whether schematic, board and pinout agree, are checked here.

mod board;
mod connectors;
mod expression;
mod rules;
mod schematic;
#[cfg(test)]
mod tests;

use crate::{process, system, workspace};
use anyhow::{Context, bail};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Arguments of `cargo xtask hardware`.
#[derive(Debug, clap::Args)]
pub(crate) struct HardwareArguments {
    /// Draw schematic and board anew from design.py first; overwrites what was changed in KiCad.
    #[arg(long)]
    draw: bool,
}

/// The Python that KiCad's modules are installed for, whatever else is on the search path.
const PYTHON: &str = "/usr/bin/python3";
const PACKAGES: [&str; 3] = ["kicad", "kicad-symbols", "kicad-footprints"];

/// A board, and the robot whose pinout it must fit.
struct Project {
    name: &'static str,
    robot: &'static str,
}

const PROJECTS: [Project; 1] = [Project {
    name: "relax-adapter",
    robot: "vileda-relax",
}];

impl Project {
    fn folder(&self) -> PathBuf {
        workspace::root().join("hardware").join(self.name)
    }

    fn read(&self, ending: &str) -> anyhow::Result<String> {
        let path = self.folder().join(format!("{}.{ending}", self.name));
        std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))
    }

    /// Everything that is wrong with the files as they are.
    fn faults(&self) -> anyhow::Result<Vec<String>> {
        let schematic = schematic::Schematic::parse(&self.read("kicad_sch")?).context("the schematic")?;
        let board = board::PadNets::parse(&self.read("kicad_pcb")?).context("the board")?;
        let pinout = workspace::root()
            .join("robots")
            .join(self.robot)
            .join("pinout.toml");
        let pinout =
            std::fs::read_to_string(&pinout).with_context(|| format!("cannot read {}", pinout.display()))?;
        let mut faults = rules::electrical_faults(&schematic);
        faults.extend(rules::differences(&schematic, &board));
        faults.extend(connectors::differences(&board, &pinout)?);
        Ok(faults)
    }
}

/// Makes everything; fails when a rule is broken.
pub(crate) fn run(arguments: &HardwareArguments) -> anyhow::Result<()> {
    if !has_kicad() {
        system::install(&PACKAGES).context("KiCad 6 is not installed")?;
    }
    system::need("rsvg-convert", &["librsvg2-bin"])?;
    for project in &PROJECTS {
        make(project, arguments).with_context(|| project.name)?;
    }
    Ok(())
}

fn has_kicad() -> bool {
    let mut python = Command::new(PYTHON);
    python.args(["-c", "import pcbnew"]);
    process::finish(&mut python).is_ok_and(|output| output.status.success())
}

fn make(project: &Project, arguments: &HardwareArguments) -> anyhow::Result<()> {
    let folder = project.folder();
    if arguments.draw {
        process::run(&format!("draw {}", project.name), tool("draw.py").arg(&folder))?;
    }
    let made = folder.join("made");
    let board = folder.join(format!("{}.kicad_pcb", project.name));
    process::run(
        "fill zones, check design rules, write Gerber files",
        tool("export.py").arg(&board).arg(&made),
    )?;
    let faults = project.faults()?;
    if !faults.is_empty() {
        bail!("electrical rules: {}", faults.join("; "));
    }
    process::say(
        "electrical rules, schematic against board, connectors against the robot's pinout: nothing found",
    );
    pictures(project, &folder, &made)
}

fn pictures(project: &Project, folder: &Path, made: &Path) -> anyhow::Result<()> {
    let drawings = workspace::target().join("hardware").join(project.name);
    process::run(
        "draw pictures",
        tool("picture.py").arg(folder).arg(project.name).arg(&drawings),
    )?;
    let svg = |name: &str| drawings.join(format!("{name}.svg"));
    for (name, width) in [
        ("schematic", "2800"),
        ("board-upper", "1600"),
        ("board-lower", "1600"),
    ] {
        let mut convert = Command::new("rsvg-convert");
        convert.args(["--width", width, "--output"]);
        convert.arg(made.join(format!("{name}.png"))).arg(svg(name));
        process::run(&format!("{name}.png"), &mut convert)?;
    }
    let mut convert = Command::new("rsvg-convert");
    // A PDF names the moment when it was made; this one is the same whenever it is made.
    convert.env("SOURCE_DATE_EPOCH", "0");
    convert.args(["--format", "pdf", "--output"]);
    convert.arg(made.join(format!("{}.pdf", project.name)));
    convert.args(["schematic", "board-upper", "board-lower"].map(svg));
    process::run("the PDF", &mut convert)?;
    process::say(&format!("all of it is in {}", made.display()));
    Ok(())
}

fn tool(script: &str) -> Command {
    let mut python = Command::new(PYTHON);
    // No folders of compiled Python between the sources.
    python.arg("-B");
    python.arg(workspace::root().join("hardware/kicad").join(script));
    python
}
