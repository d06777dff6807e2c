//! Compiles the programs for a board's processor: Zig is linker and C compiler for all of them, the standard library is compiled along.

use super::machine::Machine;
use crate::{fetched, process, toolchain};
use anyhow::{Context, bail};
use std::path::{Path, PathBuf};

/// Crates whose programs go into the package, and the programs.
const PROGRAMS: [(&str, &str); 7] = [
    ("vthal", "vthal"),
    ("panel-server", "panel-server"),
    ("rvac-cli", "rvac"),
    ("rvac-mqtt", "rvac-mqtt"),
    ("rvac-metrics", "rvac-metrics"),
    ("rvac-hooks", "rvac-hooks"),
    ("rvac-dialect", "rvac-dialect"),
];

/// Zig as a C compiler and linker, and what starts it for cargo: both are published on PyPI.
const ZIG: [&str; 2] = ["ziglang==0.17.1", "cargo-zigbuild==0.24.1"];

/// zigbuild finds the C library of its own; rustc would look for one in the place of an installed target.
const FLAGS: &str = "-Clink-self-contained=no -Cstrip=symbols";

/// Builds the programs for `machine`; gives their paths.
pub(super) fn programs(machine: Machine) -> anyhow::Result<Vec<PathBuf>> {
    let environment = fetched::python(&super::folder().join("zig"), &ZIG, "cargo-zigbuild")?;
    let out = super::folder().join("target");
    let mut cargo = toolchain::source_cargo()?;
    cargo
        .args(["zigbuild", "--locked", "--release"])
        .arg("-Zbuild-std=std,panic_unwind")
        .args(["--target", machine.triple(), "--target-dir"])
        .arg(&out)
        .env("PATH", search_path(&environment)?)
        .env(flags_variable(machine), FLAGS);
    for (package, _) in PROGRAMS {
        cargo.args(["--package", package]);
    }
    process::run(
        &format!(
            "compile the programs for {} (about ten minutes the first time)",
            machine.name()
        ),
        &mut cargo,
    )?;
    let folder = out.join(machine.triple()).join("release");
    let programs: Vec<PathBuf> = PROGRAMS.iter().map(|(_, program)| folder.join(program)).collect();
    if let Some(missing) = programs.iter().find(|program| !program.is_file()) {
        bail!("{} was not built", missing.display());
    }
    Ok(programs)
}

/// Ours first, so that `cargo zigbuild` and `python3 -m ziglang` are found.
fn search_path(environment: &Path) -> anyhow::Result<std::ffi::OsString> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(environment.to_path_buf()).chain(std::env::split_paths(&path));
    std::env::join_paths(folders).context("the search path")
}

fn flags_variable(machine: Machine) -> String {
    let triple = machine.triple().to_uppercase().replace('-', "_");
    format!("CARGO_TARGET_{triple}_RUSTFLAGS")
}
