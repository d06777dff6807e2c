//! What `cargo xtask bench safety` compares its figures with, or writes them to.

use super::BenchArguments;
use crate::{process, workspace};
use std::ffi::OsString;

/// Worst figures of the last long run.
const MEASURED: &str = "protocol/measured.toml";

/// Arguments of the measuring program that follow; the tests of cordlib have then run and left their figures.
pub(super) fn compared(arguments: &BenchArguments) -> anyhow::Result<Vec<OsString>> {
    let way = match (arguments.write, arguments.check) {
        (true, _) => "--write",
        (false, true) => "--check",
        (false, false) => return Ok(Vec::new()),
    };
    let printed = workspace::target().join("figures-of-tests.txt");
    let mut tests = workspace::cargo();
    tests.args(["test", "--locked", "--package", "cordlib", "--test", "all"]);
    tests.args(["--", "--nocapture", "--test-threads", "1"]);
    process::say("the tests of cordlib and their figures");
    std::fs::write(&printed, process::capture(&mut tests)?)?;
    let measured = workspace::root().join(MEASURED);
    Ok([way.into(), measured.into(), "--tests".into(), printed.into()].into())
}
