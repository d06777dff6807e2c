//! The C header of cordlib, which cordlib-c makes from its own sources.

use super::Generated;
use crate::{process, workspace};
use anyhow::Context;
use std::path::Path;

const HEADER: &str = "firmware/cordlib-c/include/cordlib.h";

/// The header as it should be. The generator writes it into its place; what stood there before is put back, so that the
/// caller alone decides what is written.
pub(super) fn files(root: &Path) -> anyhow::Result<Vec<Generated>> {
    let path = root.join(HEADER);
    let before = std::fs::read(&path).with_context(|| format!("cannot read {HEADER}"))?;
    let mut generator = workspace::cargo();
    generator.args([
        "run",
        "--quiet",
        "--locked",
        "--package",
        "cordlib-c",
        "--bin",
        "generate-header",
    ]);
    process::run("make cordlib.h", &mut generator)?;
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {HEADER}"))?;
    std::fs::write(&path, before).with_context(|| format!("cannot write {HEADER}"))?;
    Ok(vec![Generated { path, text }])
}
