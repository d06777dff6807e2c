//! Home Assistant for the trials of the bridges, from PyPI.

use crate::{fetched, process, system, workspace};
use anyhow::{Context, ensure};
use std::path::{Path, PathBuf};
use std::process::Command;

/// What Home Assistant asks for when it starts, in the versions that its own list names.
const PARTS: [&str; 5] = [
    "home-assistant-frontend",
    "paho-mqtt",
    "SQLAlchemy",
    "fnv-hash-fast",
    "psutil-home-assistant",
];

/// Discovery of whole devices came with 2024.11, which asks for this Python.
const LEAST_PYTHON: [u32; 2] = [3, 12];

/// In a network of its own, where this user may make one: Home Assistant looks for devices in any other.
pub(super) fn alone(trials: &Path) -> Command {
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
pub(super) fn installed() -> anyhow::Result<PathBuf> {
    let environment = workspace::target().join("joined/home-assistant");
    let hass = environment.join("bin/hass");
    let marker = environment.join("complete");
    if marker.is_file() {
        return Ok(hass);
    }
    let python = newest_python();
    let version = version(&python);
    ensure!(
        version.as_slice() >= LEAST_PYTHON.as_slice(),
        "Home Assistant with discovery of devices needs Python 3.12 or newer, but the newest found is {version:?}: install one, \
         for example with pyenv, or leave --long away"
    );
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
    pip.arg(package.join("package_constraints.txt")).args(PARTS);
    process::run("install the parts of Home Assistant", &mut pip)?;
    std::fs::write(&marker, "").with_context(|| format!("cannot write {}", marker.display()))?;
    Ok(hass)
}

/// The newest Python of this machine, if it is as new as that.
pub(super) fn python_from(least: &[u32]) -> Option<PathBuf> {
    let python = newest_python();
    (version(&python).as_slice() >= least).then_some(python)
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
    // A shim without a Python behind it complains at length, and fails.
    let told = process::finish(Command::new(python).arg("--version"));
    let told = told.map_or_else(|_| Vec::new(), |told| told.stdout);
    let told = String::from_utf8_lossy(&told);
    let numbers = told.trim().trim_start_matches("Python ").split('.');
    numbers.map_while(|number| number.parse().ok()).collect()
}
