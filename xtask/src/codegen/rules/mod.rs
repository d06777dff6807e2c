//! The safety rules: protocol/rules.toml and protocol/measured.toml, made into constants, limits and tables.

mod measured;
mod model;
mod source;
mod tables;
mod truth;
mod unit;

use super::{Generated, formatted};
use anyhow::Context;
use measured::MeasuredFigures;
use model::RuleBook;
use std::path::Path;

/// Period over which events are spread where a rule has none of its own, ms: that of `info`.
const USUAL_PERIOD_MS: u32 = 1_000;

/// All files that are made from the rules.
pub(super) fn files(root: &Path) -> anyhow::Result<Vec<Generated>> {
    let read =
        |path: &str| std::fs::read_to_string(root.join(path)).with_context(|| format!("cannot read {path}"));
    let book = RuleBook::parse(&read("protocol/rules.toml")?)?;
    let measured = MeasuredFigures::parse(&read("protocol/measured.toml")?)?;
    let inhibits = truth::check(root, &book, &measured)?;
    let figures: Vec<String> = book
        .shown
        .iter()
        .flat_map(|shown| shown.figures.clone())
        .collect();
    let of_tests = |name: &str| {
        figures
            .iter()
            .any(|figure| super::rust_name::constant(figure) == name)
    };
    let of_trials = source::of_limits(&book, |_| true)? + &source::of_observers(&book)?;
    let rust = [
        (
            "firmware/cordlib/src/rules.rs",
            source::of_cordlib(&book, &inhibits)?,
        ),
        (
            "firmware/cordlib/tests/all/rig/limits.rs",
            source::of_limits(&book, of_tests)?,
        ),
        ("sim/monitor/src/limits.rs", source::of_monitor(&book)?),
        ("sim/trials/src/limits.rs", of_trials),
    ];
    let mut files = Vec::new();
    for (path, text) in rust {
        files.push(Generated {
            text: formatted(&text).context(path)?,
            path: root.join(path),
        });
    }
    let page = tables::renewed(&read("SAFETY.md")?, &book, &measured)?;
    for (path, text) in [
        ("firmware/cordlib-c/include/cordlib-rules.h", source::in_c(&book)?),
        ("SAFETY.md", page),
    ] {
        files.push(Generated {
            path: root.join(path),
            text,
        });
    }
    Ok(files)
}
