//! `cargo xtask codegen`: files that are made from data. With --check it writes nothing and names what is stale.

pub(crate) mod board;
pub(crate) mod drawings;
mod header;
pub(crate) mod machines;
pub(crate) mod robots;
mod rules;
mod rust_name;

use crate::{process, workspace};
use anyhow::{Context, bail};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Arguments of `cargo xtask codegen`.
#[derive(Debug, clap::Args)]
pub(crate) struct CodegenArguments {
    /// Write nothing; fail when a file is stale.
    #[arg(long)]
    pub(crate) check: bool,
}

/// A file that is made from data.
pub(crate) struct Generated {
    path: PathBuf,
    text: String,
}

/// Makes all generated files.
pub(crate) fn run(arguments: &CodegenArguments) -> anyhow::Result<()> {
    let root = workspace::root();
    let mut stale = Vec::new();
    // The header of cordlib is made by a program that contains what the steps before it make.
    for step in [
        rules::files,
        board::files,
        robots::files,
        machines::files,
        drawings::files,
        header::files,
    ] {
        stale.extend(renew(&root, step(&root)?, arguments)?);
    }
    if arguments.check && !stale.is_empty() {
        bail!(
            "stale: {}; run cargo xtask codegen and commit the result",
            stale.join(", ")
        );
    }
    Ok(())
}

/// Writes what differs, unless it is only to be checked, and names it.
fn renew(root: &Path, files: Vec<Generated>, arguments: &CodegenArguments) -> anyhow::Result<Vec<String>> {
    let mut stale = Vec::new();
    for file in files {
        let present = std::fs::read_to_string(&file.path).unwrap_or_default();
        if present == file.text {
            continue;
        }
        let shown = file
            .path
            .strip_prefix(root)
            .unwrap_or(&file.path)
            .display()
            .to_string();
        if !arguments.check {
            if let Some(folder) = file.path.parent() {
                std::fs::create_dir_all(folder)
                    .with_context(|| format!("cannot make {}", folder.display()))?;
            }
            std::fs::write(&file.path, &file.text).with_context(|| format!("cannot write {shown}"))?;
            process::say(&format!("wrote {shown}"));
        }
        stale.push(shown);
    }
    Ok(stale)
}

/// The source as rustfmt writes it, so that the generated files are formatted like all others.
fn formatted(text: &str) -> anyhow::Result<String> {
    let mut rustfmt = Command::new("rustfmt");
    rustfmt
        .args(["--edition", "2024", "--config-path"])
        .arg(workspace::root());
    rustfmt.stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = rustfmt
        .spawn()
        .with_context(|| format!("cannot start {}", process::name(&rustfmt)))?;
    if let Some(mut stdin) = child.stdin.take() {
        stdin.write_all(text.as_bytes())?;
    }
    let output = child.wait_with_output()?;
    if !output.status.success() {
        bail!("rustfmt does not understand what was made");
    }
    Ok(String::from_utf8(output.stdout)?)
}
