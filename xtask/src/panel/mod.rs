//! Builds the panel: WebAssembly by whatever compiler this machine has for it, then packed into one folder of files.

mod ahead;

use crate::{process, toolchain, workspace};
use anyhow::bail;
use std::path::PathBuf;
use std::process::Command;

pub(crate) use ahead::Ahead;

/// The WebAssembly that cargo leaves, below the target folder of the panel.
const WASM: &str = "wasm32-unknown-unknown/release/panel.wasm";

/// Builds and packs the panel; gives the folder that the panel server serves.
pub(crate) fn build() -> anyhow::Result<PathBuf> {
    let wasm = compile()?;
    let folder = workspace::target().join("panel");
    let mut pack = workspace::cargo();
    pack.args([
        "run",
        "--quiet",
        "--locked",
        "--manifest-path",
        "xtask/uipack/Cargo.toml",
        "--target-dir",
    ])
    .arg(workspace::target().join("uipack"))
    .arg("--")
    .arg(&wasm)
    .arg(&folder);
    process::run(
        "pack the panel (its packer takes about 30 s to build the first time)",
        &mut pack,
    )?;
    Ok(folder)
}

fn compile() -> anyhow::Result<PathBuf> {
    let (toolchain, mut cargo) = compilation()?;
    process::run(
        &format!("build the panel with {toolchain} (about four minutes the first time)"),
        &mut cargo,
    )?;
    let wasm = folder().join(WASM);
    if !wasm.is_file() {
        bail!(
            "the panel was built but {} is missing; is its program still called panel?",
            wasm.display()
        );
    }
    Ok(wasm)
}

/// Where the compiler leaves the panel: a folder that no other build locks.
fn folder() -> PathBuf {
    workspace::target().join("panel-wasm")
}

/// The compiler's name and the command that compiles the panel.
fn compilation() -> anyhow::Result<(String, Command)> {
    let toolchain = toolchain::choose(&toolchain::WEB)?;
    let mut cargo = toolchain.cargo();
    cargo
        .args([
            "build",
            "--release",
            "--locked",
            "--manifest-path",
            "clients/panel/Cargo.toml",
        ])
        .args(["--target", toolchain::WEB.triple, "--target-dir"])
        .arg(folder());
    Ok((toolchain.name(), cargo))
}
