//! Stages that look for something rare: many packets, many seeds, many moments at which a process is killed.

use super::extent::Extent;
use super::runner::{Result, cargo, check, checks, checks_side_by_side};
use crate::firmware;
use crate::workspace::{self, Profile, program};
use std::process::Command;

/// A program of the workspace that stands in the root of the repository.
fn started(name: &str) -> Command {
    let mut command = Command::new(program(name, Profile::Dev));
    command.current_dir(workspace::root());
    command
}

/// Corrupted packets cause no wrong actuation.
pub(super) fn link(extent: Extent) -> Result {
    workspace::build(&["bench-link"], Profile::Dev)?;
    let mut command = started("bench-link");
    command.arg("--json").args(extent.pick(
        ["--packets", "100000"].as_slice(),
        &["--packets", "1000000"],
        &["--long"],
    ));
    check(&mut command)
}

/// Many runs of the logic built for this machine and some of them for the other robot, and what fails around the Linux board; with the
/// campaigns a few runs of the real firmware, too, which take two thousand times as long.
pub(super) fn faults(extent: Extent) -> Result {
    workspace::build(&["rvac-sim", "bench-board"], Profile::Dev)?;
    let run = |words: &[&str]| {
        let mut command = started("rvac-sim");
        command.arg("faults").args(words);
        command
    };
    let seeds = extent.pick("0..50", "0..1000", "0..100000");
    let minutes = extent.pick("2", "2", "10");
    let other_seeds = extent.pick("0..10", "0..100", "0..10000");
    let mut board = started("bench-board");
    board.args(["--seeds", extent.pick("46", "1000", "10000")]);
    let mut commands = vec![
        run(&["--seeds", seeds, "--minutes", minutes]),
        run(&["--robot", "relax", "--seeds", other_seeds, "--minutes", "2"]),
        board,
    ];
    if extent.has_campaigns() {
        let seeds = extent.pick("", "0..4", "0..100");
        let mut on_chip = run(&["--seeds", seeds, "--minutes", "1", "--firmware"]);
        on_chip.arg(firmware::usual_elf()?);
        commands.push(on_chip);
    }
    checks_side_by_side(commands)
}

/// The demo cleans without a browser; with the campaigns the emulated robot does, too.
pub(super) fn headless(extent: Extent) -> Result {
    let minutes = extent.pick("1", "3", "3");
    let demo = |words: &[&str]| {
        let mut command = cargo(&["xtask", "demo", "--headless", "--seed", "1"]);
        command.args(words);
        command
    };
    let mut commands = vec![demo(&["--minutes", minutes])];
    if extent.has_campaigns() {
        commands.push(demo(&["--emulated", "--minutes", "0.5"]));
    }
    checks_side_by_side(commands)
}

/// A robot stands soon after its daemon was killed.
pub(super) fn kill(extent: Extent) -> Result {
    workspace::build(&["rvac-sim", "vthal", "bench-kill"], Profile::Dev)?;
    let mut command = started("bench-kill");
    command.args([
        "--home",
        "homes/two-room-flat.toml",
        "--robots",
        "4",
        "--kills",
        extent.pick("8", "20", "200"),
    ]);
    check(&mut command)
}

/// Nothing acknowledged is lost when what keeps it is killed while it writes, or when its disk fails.
pub(super) fn writes(extent: Extent) -> Result {
    workspace::build(&["vthal", "panel-server", "bench-writes"], Profile::Dev)?;
    let mut kills = started("bench-writes");
    kills.args(["--kills", extent.pick("100", "1000", "100000")]);
    let mut commands = vec![kills];
    if extent.has_campaigns() {
        let mut faults = started("bench-writes");
        faults.arg("--faults");
        commands.push(faults);
    }
    checks(&mut commands)
}
