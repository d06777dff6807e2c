//! Builds the panel: WebAssembly by whatever compiler this machine has for it, then packed into one folder of files.

mod ahead;
mod first_load;
mod page;

use crate::{process, toolchain, workspace};
use anyhow::bail;
use std::path::PathBuf;
use std::process::Command;

pub(crate) use ahead::Ahead;
pub(crate) use page::Page;

/// Options of the subcommand.
#[derive(Debug, clap::Args)]
pub(crate) struct PanelArguments {
    /// Print what a first visit brings over the network as one JSON object
    #[arg(long)]
    json: bool,
}

/// Builds the page of a release, and says where it is or how large.
pub(crate) fn run(arguments: &PanelArguments) -> anyhow::Result<()> {
    let folder = build(Page::Release)?;
    if arguments.json {
        return first_load::print(&folder);
    }
    process::say(&format!("the panel is in {}", folder.display()));
    Ok(())
}

/// Builds and packs the panel; gives the folder that the panel server serves.
pub(crate) fn build(page: Page) -> anyhow::Result<PathBuf> {
    let wasm = compile(page)?;
    let folder = page.folder();
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

fn compile(page: Page) -> anyhow::Result<PathBuf> {
    let (toolchain, mut cargo) = compilation(page)?;
    let minutes = match page {
        Page::Release => "about nine minutes",
        Page::Demo => "about four minutes",
    };
    process::run(
        &format!("build the panel with {toolchain} ({minutes} the first time)"),
        &mut cargo,
    )?;
    let wasm = page
        .target()
        .join(toolchain::WEB.triple)
        .join(page.profile())
        .join("panel.wasm");
    if !wasm.is_file() {
        bail!(
            "the panel was built but {} is missing; is its program still called panel?",
            wasm.display()
        );
    }
    Ok(wasm)
}

/// The compiler's name and the command that compiles the panel.
fn compilation(page: Page) -> anyhow::Result<(String, Command)> {
    let toolchain = toolchain::choose(&toolchain::WEB)?;
    let mut cargo = toolchain.cargo();
    cargo
        .args(["build", "--locked", "--profile", page.profile()])
        .args(["--manifest-path", "clients/panel/Cargo.toml"])
        .args(["--target", toolchain::WEB.triple, "--target-dir"])
        .arg(page.target());
    Ok((toolchain.name(), cargo))
}
