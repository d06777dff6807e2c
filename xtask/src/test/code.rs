//! Stages that look at the code: its form, its rules, its lints, its examples.

use super::count::Count;
use super::extent::Extent;
use super::runner::{Result, cargo, check, checks};
use crate::{book, codegen, system, tidy, workspace};

/// Manifests of the workspaces besides the main one.
const OTHERS: [&str; 10] = [
    "clients/foxglove/Cargo.toml",
    "clients/matter/Cargo.toml",
    "clients/panel/Cargo.toml",
    "clients/ros2/Cargo.toml",
    "firmware/size-probe/Cargo.toml",
    "firmware/pic32mx3-hal/Cargo.toml",
    "firmware/sr8730/Cargo.toml",
    "sim/pic32/proof/Cargo.toml",
    "xtask/uipack/Cargo.toml",
    "protocol/fuzz/Cargo.toml",
];

fn one(result: anyhow::Result<()>) -> Result {
    result?;
    Ok(Count::ONE)
}

/// All workspaces are formatted.
pub(super) fn fmt(_extent: Extent) -> Result {
    let mut commands = vec![cargo(&["fmt", "--all", "--check"])];
    commands.extend(OTHERS.map(|manifest| cargo(&["fmt", "--all", "--check", "--manifest-path", manifest])));
    checks(&mut commands)
}

/// The rules of the repository hold.
pub(super) fn tidy(_extent: Extent) -> Result {
    one(tidy::run())
}

/// Generated files are fresh.
pub(super) fn codegen(_extent: Extent) -> Result {
    one(codegen::run(&codegen::CodegenArguments { check: true }))
}

/// The linter finds nothing. The attacks are no test of `--all-targets`, because they have a stage of their own.
pub(super) fn clippy(_extent: Extent) -> Result {
    let targets: [&[&str]; 2] = [&["--workspace", "--all-targets"], &["--test", "attacks"]];
    let mut commands = targets.map(|targets| {
        let mut command = cargo(&["clippy", "--locked"]);
        command.args(targets).args(["--", "-D", "warnings"]);
        command
    });
    checks(&mut commands)
}

/// The book becomes a site, and each of its links leads somewhere.
pub(super) fn book(_extent: Extent) -> Result {
    one(book::build().map(|_| ()))
}

/// Examples in the documentation compile and run.
pub(super) fn doctests(_extent: Extent) -> Result {
    check(&mut cargo(&[
        "test",
        "--workspace",
        "--locked",
        "--doc",
        "--no-fail-fast",
    ]))
}

/// The bodies of the targets run on mutated packets among the tests of rvac-protocol; here the targets are linked.
pub(super) fn fuzz(_extent: Extent) -> Result {
    system::need("c++", &["g++"])?;
    let mut command = cargo(&["build", "--locked", "--manifest-path", "protocol/fuzz/Cargo.toml"]);
    command.arg("--target-dir").arg(workspace::target().join("fuzz"));
    check(&mut command)
}
