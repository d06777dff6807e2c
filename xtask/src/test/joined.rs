//! The stage that tries the bridges against the software that homes have.

use super::extent::Extent;
use super::runner::{Result, check};
use crate::workspace::{self, Profile, program};
use crate::{fetched, process, system};
use anyhow::Context;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Programs of ours that are tried, and what they stand on.
const PROGRAMS: [&str; 6] = [
    "rvac-sim",
    "vthal",
    "rvac-mqtt",
    "rvac-metrics",
    "rvac-hooks",
    "try-joined",
];

/// A reader of calendars that nobody here wrote.
const ICALENDAR: &str = "icalendar==6.3.1";

/// What Home Assistant asks for when it starts, in the versions that its own list names.
const HOME_ASSISTANT_PARTS: [&str; 5] = [
    "home-assistant-frontend",
    "paho-mqtt",
    "SQLAlchemy",
    "fnv-hash-fast",
    "psutil-home-assistant",
];

/// mosquitto, Prometheus and Python; with `--long` Home Assistant, too.
pub(super) fn joined(extent: Extent) -> Result {
    check(&mut trials(extent)?)
}

/// All of them, with what they saw as one JSON object on the output stream.
pub(super) fn as_json() -> anyhow::Result<()> {
    let seen = process::finish(
        trials(Extent::Long)?
            .arg("--json")
            .stderr(std::process::Stdio::inherit()),
    )?;
    process::print(String::from_utf8_lossy(&seen.stdout).trim());
    anyhow::ensure!(seen.status.success(), "some checks failed");
    Ok(())
}

fn trials(extent: Extent) -> anyhow::Result<Command> {
    if !Path::new("/usr/sbin/mosquitto").is_file() {
        system::need("mosquitto", &["mosquitto"])?;
    }
    system::need("mosquitto_sub", &["mosquitto-clients"])?;
    system::need("promtool", &["prometheus"])?;
    system::need("python3", &["python3"])?;
    workspace::build(&PROGRAMS, Profile::Dev)?;
    let trials = program("try-joined", Profile::Dev);
    let calendar = workspace::target().join("joined/calendar");
    let python = fetched::python(&calendar, &[ICALENDAR], "icalendar")?.join("python");
    let mut command = if extent < Extent::Long {
        Command::new(trials)
    } else {
        let hass = home_assistant()?;
        let mut command = alone(&trials);
        command.arg("--long").arg("--hass").arg(hass);
        command
    };
    command.arg("--python").arg(python);
    Ok(command)
}

/// In a network of its own, where this user may make one: Home Assistant looks for devices in any other.
fn alone(trials: &Path) -> Command {
    let may = rustix::process::geteuid().is_root()
        && system::find("unshare").is_some()
        && system::find("ip").is_some();
    if !may {
        return Command::new(trials);
    }
    let mut command = Command::new("unshare");
    command
        .args(["--net", "sh", "-c", "ip link set lo up && exec \"$@\"", "sh"])
        .arg(trials);
    command
}

/// The newest Home Assistant that the newest Python of this machine takes.
fn home_assistant() -> anyhow::Result<PathBuf> {
    let environment = workspace::target().join("joined/home-assistant");
    let hass = environment.join("bin/hass");
    let marker = environment.join("complete");
    if marker.is_file() {
        return Ok(hass);
    }
    let python = newest_python();
    let programs = fetched::python_of(&python, &environment, (&["homeassistant"], "hass"))?;
    let mut find = Command::new(programs.join("python"));
    find.args([
        "-c",
        "import homeassistant, os; print(os.path.dirname(homeassistant.__file__))",
    ]);
    let package = PathBuf::from(process::capture(&mut find)?.trim());
    let mut pip = Command::new(programs.join("pip"));
    pip.args([
        "install",
        "--quiet",
        "--disable-pip-version-check",
        "--constraint",
    ]);
    pip.arg(package.join("package_constraints.txt"))
        .args(HOME_ASSISTANT_PARTS);
    process::run("install the parts of Home Assistant", &mut pip)?;
    std::fs::write(&marker, "").with_context(|| format!("cannot write {}", marker.display()))?;
    Ok(hass)
}

/// On the search path, or below the folder in which pyenv keeps its own.
fn newest_python() -> PathBuf {
    let mut found = vec![PathBuf::from("python3")];
    found.extend(
        (11..=16)
            .rev()
            .filter_map(|minor| system::find(&format!("python3.{minor}"))),
    );
    if let Some(home) = std::env::var_os("HOME") {
        let versions = std::fs::read_dir(Path::new(&home).join(".pyenv/versions"));
        let folders = versions.into_iter().flatten().filter_map(std::result::Result::ok);
        found.extend(folders.map(|folder| folder.path().join("bin/python3")));
    }
    let usual = PathBuf::from("python3");
    found
        .into_iter()
        .max_by_key(|python| version(python))
        .unwrap_or(usual)
}

/// Of a Python that works, for example 3, 13, 0.
fn version(python: &Path) -> Vec<u32> {
    let told = process::capture(
        Command::new(python)
            .arg("--version")
            .stderr(std::process::Stdio::null()),
    );
    let told = told.unwrap_or_default();
    let numbers = told.trim().trim_start_matches("Python ").split('.');
    numbers.map_while(|number| number.parse().ok()).collect()
}
