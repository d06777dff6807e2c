//! Mutants of cordlib's logic: each change of one expression in reflexes, charger, arming or leases, and whether a test notices.

use super::BenchArguments;
use crate::{process, system, workspace};
use anyhow::Context;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Command;

/// What makes the mutants and runs the tests; fetched when it is missing.
const TOOL: &str = "cargo-mutants";
/// Where the robot's safety is decided.
const FILES: [&str; 9] = [
    "firmware/cordlib/src/reflex/*.rs",
    "firmware/cordlib/src/charge/*.rs",
    "firmware/cordlib/src/arming.rs",
    "firmware/cordlib/src/permit.rs",
    "firmware/cordlib/src/cleaning.rs",
    "firmware/cordlib/src/guarded.rs",
    "firmware/cordlib/src/causes.rs",
    "firmware/cordlib/src/dock_escape.rs",
    "firmware/cordlib/src/motion/mod.rs",
];
/// Its own tests, among them the monitor's storm, and charges of simulated packs.
const JUDGES: [&str; 2] = ["cordlib", "robot"];
/// Without `--long` one mutant in so many is tried.
const SHARE: &str = "0/100";
/// A mutant that loops for ever is noticed by then.
const PATIENCE_S: &str = "300";
/// Share of the mutants that must be noticed.
const NOTICED_SHARE: f64 = 0.95;

/// Runs the campaign; fails when too many survive.
pub(super) fn run(arguments: &BenchArguments) -> anyhow::Result<()> {
    let output = workspace::target().join("logic-mutants");
    std::fs::create_dir_all(&output)?;
    let mut command = Command::new(tool()?);
    command.current_dir(workspace::root());
    command.args([
        "mutants",
        "--no-times",
        "--colors",
        "never",
        "--package",
        "cordlib",
    ]);
    command.args(["--timeout", PATIENCE_S, "--jobs", "1", "--output"]);
    command.arg(&output);
    for file in FILES {
        command.args(["--file", file]);
    }
    for package in JUDGES {
        command.args(["--test-package", package]);
    }
    if !arguments.long {
        command.args(["--shard", SHARE, "--sharding", "round-robin"]);
    }
    command.args(&arguments.rest);
    process::say(&process::name(&command));
    // It ends with an error when a mutant survives, which the figures tell better.
    command.stdout(std::io::stderr()).status()?;
    let figures = figures(&output.join("mutants.out/outcomes.json"))?;
    tell(arguments, &figures);
    let count = |key: &str| figures[key].as_f64().unwrap_or(0.0);
    anyhow::ensure!(
        count("made") > 0.0 && count("noticed") >= NOTICED_SHARE * count("made"),
        "too many mutants were not noticed"
    );
    Ok(())
}

/// The tool on the search path, or one of our own.
fn tool() -> anyhow::Result<PathBuf> {
    if let Some(found) = system::find(TOOL) {
        return Ok(found);
    }
    let folder = workspace::target().join("tools");
    let own = folder.join("bin").join(TOOL);
    if !own.is_file() {
        let mut install = workspace::cargo();
        install.args(["install", "--locked", TOOL, "--root"]).arg(&folder);
        process::run(&format!("install {TOOL}"), &mut install)?;
    }
    Ok(own)
}

/// What came of all mutants that could be compiled.
fn figures(outcomes: &Path) -> anyhow::Result<Value> {
    let text = std::fs::read_to_string(outcomes).with_context(|| {
        format!(
            "the tests of the unchanged code failed: there is no {}",
            outcomes.display()
        )
    })?;
    let read: Value = serde_json::from_str(&text)?;
    let number = |key: &str| read[key].as_u64().unwrap_or(0);
    let survivors: Vec<&str> = read["outcomes"]
        .as_array()
        .into_iter()
        .flatten()
        .filter(|outcome| outcome["summary"] == "MissedMutant")
        .filter_map(|outcome| outcome["scenario"]["Mutant"]["name"].as_str())
        .collect();
    let noticed = number("caught") + number("timeout");
    Ok(json!({
        "made": noticed + number("missed"), "noticed": noticed, "survivors": number("missed"), "not-compiled": number("unviable"),
        "survived": survivors,
    }))
}

fn tell(arguments: &BenchArguments, figures: &Value) {
    if arguments.json {
        process::print(&figures.to_string());
        return;
    }
    for name in figures["survived"].as_array().into_iter().flatten() {
        process::print(&format!("survived: {}", name.as_str().unwrap_or_default()));
    }
    process::print(&format!(
        "{} of {} mutants were noticed, {} do not compile",
        figures["noticed"], figures["made"], figures["not-compiled"]
    ));
}
