//! `cargo xtask codegen`: files that are made from data. With --check it writes nothing and names what is stale.

pub(crate) mod board;
mod header;
pub(crate) mod robots;

use crate::{process, workspace};
use anyhow::{Context, bail};
use std::path::PathBuf;

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
    let mut files = board::files(&root)?;
    files.extend([robots::page(&root)?, header::of_cordlib(&root)?]);
    let mut stale = Vec::new();
    for file in files {
        let present = std::fs::read_to_string(&file.path).unwrap_or_default();
        if present == file.text {
            continue;
        }
        let shown = file
            .path
            .strip_prefix(&root)
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
    if arguments.check && !stale.is_empty() {
        bail!(
            "stale: {}; run cargo xtask codegen and commit the result",
            stale.join(", ")
        );
    }
    Ok(())
}
