//! Stages that run the tests of the workspace and of the panel's logic.

use super::extent::Extent;
use super::runner::{Result, all, cargo, check, checks, tests};
use crate::system;
use crate::workspace::{self, Profile};
use std::env;
use std::process::Command;

/// Prepares what tests start: programs of the workspace, a C compiler, Raku. What needs the firmware of a robot or another
/// emulator passes itself over here, and has a stage of its own.
pub(super) fn workspace_tests(extent: Extent) -> Result {
    system::need("cc", &["gcc", "libc6-dev"])?;
    system::need("raku", &["rakudo"])?;
    system::need("socat", &["socat"])?;
    system::need("node", &["nodejs"])?;
    system::need("python3", &["python3"])?;
    system::need("curl", &["curl"])?;
    let build = check(&mut cargo(&["build", "--workspace", "--locked", "--all-targets"]));
    let run = tests(&mut runner(extent));
    let long = LONG.iter().filter(|_| extent == Extent::Long);
    all([build, run]
        .into_iter()
        .chain(long.map(|words| tests(&mut cargo(words)))))
}

/// The words behind `--` mean the same to both runners.
fn runner(extent: Extent) -> Command {
    let mut command = if system::find("cargo-nextest").is_some() {
        cargo(&["nextest", "run", "--workspace", "--locked", "--no-fail-fast"])
    } else {
        cargo(&[
            "test",
            "--workspace",
            "--locked",
            "--all-targets",
            "--no-fail-fast",
        ])
    };
    if extent != Extent::Long && env::var_os(DRAW_SEED_VARIABLE).is_none() {
        command.env(DRAW_SEED_VARIABLE, DRAW_SEED);
    }
    if extent.has_campaigns() {
        command.args(["--", "--include-ignored"]);
        command.args(LONG_ONLY.map(|name| ["--skip", name]).concat());
    }
    command
}

/// Seed of what property tests draw, for proptest. A change is judged by the same cases as the one before it: `--long` and a plain
/// `cargo test` draw others each time, and who finds one that fails sets this variable to see it again.
const DRAW_SEED_VARIABLE: &str = "PROPTEST_RNG_SEED";
const DRAW_SEED: &str = "1";

/// Tests that are too long for `--all`. All others that are marked `#[ignore]` are campaigns and run there.
const LONG_ONLY: [&str; 4] = [
    "ten_thousand_",
    "a_million_hostile_files_get_an_answer_in_time_and_in_bounded_memory",
    "many_random_programs_end_alike",
    "each_local_time_fires_once_a_day_at_every_change",
];

/// What only `--long` runs.
const LONG: [&[&str]; 3] = [ALL_ZONES, MILLION_FILES, TEN_THOUSAND_DRAWS];

/// A million files that nobody would write, for every loader of homes: here all are of whole rooms, and in the usual tests most are of
/// homes just large enough for the robot.
const MILLION_FILES: &[&str] = &[
    "test",
    "--release",
    "--locked",
    "--package",
    "home",
    "--test",
    "all",
    "--",
    "--ignored",
    "a_million_hostile_files",
];

/// Walls, docks, edits, requests: the usual tests draw some dozens of each.
const TEN_THOUSAND_DRAWS: &[&str] = &[
    "test",
    "--workspace",
    "--locked",
    "--",
    "--ignored",
    "ten_thousand_",
];

/// Every change of the clock of every time zone, for every kind of schedule.
const ALL_ZONES: &[&str] = &[
    "test",
    "--release",
    "--locked",
    "--test",
    "schedule",
    "--",
    "--ignored",
];

/// No package is named: with one cargo would choose other features for what all share, and build it a second time.
const ATTACKS: [&str; 5] = ["test", "--quiet", "--locked", "--test", "attacks"];

/// Each line of the attack table, against a real server on real sockets; with --long also a stick that is held on while something
/// happens to connections and processes at a thousand moments.
pub(super) fn attacks(extent: Extent) -> Result {
    workspace::build(&["rvac-sim", "vthal"], Profile::Dev)?;
    let mut commands = vec![cargo(&ATTACKS)];
    if extent == Extent::Long {
        let mut held = cargo(&ATTACKS);
        held.env("RVAC_HELD_MOMENTS", "1000");
        commands.push(held);
    }
    checks(&mut commands)
}

/// The same for programs: nothing but the table goes to the output.
pub(super) fn attacks_as_json() -> anyhow::Result<()> {
    workspace::build(&["rvac-sim", "vthal"], Profile::Dev)?;
    let mut command = cargo(&ATTACKS);
    command.args(["--", "--json"]);
    let status = command.status()?;
    anyhow::ensure!(
        status.success(),
        "some attacks came out otherwise than they should"
    );
    Ok(())
}

/// The panel's logic, which needs no browser.
pub(super) fn panel(_extent: Extent) -> Result {
    let mut command = cargo(&[
        "test",
        "--locked",
        "--manifest-path",
        "clients/panel/Cargo.toml",
        "--package",
        "panel-logic",
    ]);
    command
        .arg("--target-dir")
        .arg(workspace::target().join("panel-logic"));
    tests(&mut command)
}
