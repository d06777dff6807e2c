//! measured.toml: the worst figures of the last long run.

use anyhow::Context;
use serde::Deserialize;
use std::collections::BTreeMap;

/// The whole file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeasuredFigures {
    /// Worst figures that cordlib's tests print, by limit, ms.
    #[serde(default)]
    pub(super) tests: BTreeMap<String, f64>,
    #[serde(rename = "trial", default)]
    pub(super) trials: Vec<MeasuredTrial>,
}

/// One trial on the real firmware in the emulated chip.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct MeasuredTrial {
    pub(super) name: String,
    pub(super) rule: String,
    pub(super) what: String,
    pub(super) limit: String,
    /// What an observer adds to the limit, by the name of the allowance.
    pub(super) allowance: Option<String>,
    pub(super) phases: u32,
    pub(super) worst_ms: f64,
}

impl MeasuredFigures {
    /// Reads the text of measured.toml.
    pub(super) fn parse(text: &str) -> anyhow::Result<Self> {
        toml::from_str(text).context("protocol/measured.toml")
    }
}
