//! The stage in which firmware goes into the simulated chips of both robots and comes back.

use super::extent::Extent;
use super::runner::{Result, check};
use crate::workspace::{self, Profile, program};
use crate::{fetched, firmware, process, system};
use std::path::PathBuf;
use std::process::Command;

/// A flasher that nobody here wrote, from PyPI.
const STCGAL: &str = "stcgal==1.10";

/// Backup, write, verify, restore; cut power and killed programmers; stcgal on a pseudo terminal; OpenOCD at the test port.
pub(super) fn flash(extent: Extent) -> Result {
    check(&mut campaign(extent)?)
}

/// The same, with its figures as one JSON object on the output stream.
pub(super) fn as_json(extent: Extent) -> anyhow::Result<()> {
    let figures = process::capture(campaign(extent)?.arg("--json"))?;
    process::print(figures.trim());
    Ok(())
}

fn campaign(extent: Extent) -> anyhow::Result<Command> {
    let elf = firmware::usual_elf()?;
    let stcgal = stcgal()?;
    system::need("openocd", &["openocd"])?;
    workspace::build(&["bench-flash"], Profile::Dev)?;
    let mut command = Command::new(program("bench-flash", Profile::Dev));
    command
        .current_dir(workspace::root())
        .args(["--moments", extent.pick("20", "20", "1000")])
        .arg("--firmware")
        .arg(elf)
        .arg("--stcgal")
        .arg(stcgal)
        .args(["--openocd", "openocd"]);
    Ok(command)
}

/// The program, in an environment of its own below the build's folder.
fn stcgal() -> anyhow::Result<PathBuf> {
    let programs = fetched::python(&workspace::target().join("stcgal"), &[STCGAL], "stcgal")?;
    Ok(programs.join("stcgal"))
}
