//! rules.toml as it is written, and the figures that follow from it.

use super::unit::Unit;
use crate::codegen::rust_name;
use anyhow::{Context, bail};
use serde::Deserialize;

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RuleBook {
    #[serde(rename = "allowance")]
    pub(super) allowances: Vec<Limit>,
    #[serde(rename = "rule")]
    pub(super) rules: Vec<SafetyRule>,
    #[serde(rename = "latch")]
    pub(super) latches: Vec<Latch>,
    #[serde(rename = "judge")]
    pub(super) judged: Vec<JudgeFigure>,
    #[serde(rename = "shown")]
    pub(super) shown: Vec<Evidence>,
}

/// Where a rule is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum RulePlace {
    Mcu,
    Daemon,
    Brain,
}

/// One rule.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SafetyRule {
    pub(super) id: String,
    pub(super) fault: String,
    pub(super) effect: String,
    pub(super) reaction: String,
    #[serde(default)]
    pub(super) inhibits: Vec<String>,
    pub(super) place: Vec<RulePlace>,
    pub(super) code: Vec<String>,
    pub(super) state: String,
    /// Longest period of what implements it, ms.
    pub(super) period: Option<u32>,
    #[serde(default)]
    pub(super) monitor: Vec<String>,
    #[serde(default)]
    pub(super) trials: Vec<String>,
    #[serde(default)]
    pub(super) limits: Vec<Limit>,
    #[serde(default)]
    pub(super) settings: Vec<Setting>,
}

/// What somebody outside must see, or what an observer allows for.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Limit {
    pub(super) name: String,
    pub(super) value: i64,
    pub(super) unit: Unit,
    #[serde(default)]
    pub(super) why: String,
    /// `path::NAME` of a constant with the same value that stands elsewhere.
    pub(super) stands_in: Option<String>,
}

/// What the firmware uses.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Setting {
    pub(super) module: String,
    pub(super) name: String,
    value: Option<i64>,
    unit: Option<Unit>,
    limit: Option<String>,
    #[serde(default)]
    less: i64,
    #[serde(default)]
    plus: i64,
    #[serde(default)]
    pub(super) why: String,
    #[serde(rename = "type")]
    rust_type: Option<String>,
    /// The constant's name does not end with its unit.
    #[serde(default)]
    bare: bool,
}

/// What the monitor uses.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JudgeFigure {
    pub(super) name: String,
    pub(super) limit: String,
    unit: Option<Unit>,
    #[serde(default)]
    plus: i64,
    #[serde(default)]
    pub(super) why: String,
    #[serde(rename = "type")]
    rust_type: Option<String>,
    #[serde(default)]
    bare: bool,
}

/// Inhibits that are latched, and when they can be cleared.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Latch {
    pub(super) inhibits: Vec<String>,
    pub(super) refused: String,
    pub(super) forbids: Vec<Forbidden>,
}

/// What a latch forbids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Forbidden {
    Motion,
    Charging,
}

/// How rules are shown to hold.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Evidence {
    pub(super) rules: Vec<String>,
    pub(super) how: String,
    /// Limits whose worst figure the tests print.
    #[serde(default)]
    pub(super) figures: Vec<String>,
    #[serde(default)]
    pub(super) result: String,
}

/// A constant in Rust.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Constant {
    pub(super) name: String,
    pub(super) rust_type: String,
    pub(super) value: i64,
    pub(super) unit: Unit,
}

impl RuleBook {
    /// Reads the text of rules.toml.
    pub(super) fn parse(text: &str) -> anyhow::Result<Self> {
        toml::from_str(text).context("protocol/rules.toml")
    }

    /// The limit that `S6.stop` names.
    pub(super) fn limit(&self, reference: &str) -> anyhow::Result<&Limit> {
        let found = reference.split_once('.').and_then(|(id, name)| {
            let rule = self.rules.iter().find(|rule| rule.id == id)?;
            rule.limit(name)
        });
        found.with_context(|| format!("protocol/rules.toml has no limit {reference}"))
    }
}

impl SafetyRule {
    pub(super) fn limit(&self, name: &str) -> Option<&Limit> {
        self.limits.iter().find(|limit| limit.name == name)
    }

    /// A text of the rule with its limits in place of their names.
    pub(super) fn filled(&self, text: &str) -> anyhow::Result<String> {
        let mut out = text.to_owned();
        for limit in &self.limits {
            out = out.replace(&format!("{{{}}}", limit.name), &limit.unit.shown(limit.value));
        }
        if out.contains('{') {
            bail!(
                "protocol/rules.toml: {}: {text:?} names a limit that it has not",
                self.id
            );
        }
        Ok(out)
    }
}

impl Setting {
    /// The constant that it becomes.
    pub(super) fn constant(&self, rule: &SafetyRule) -> anyhow::Result<Constant> {
        let (value, unit) = match (&self.limit, self.value, self.unit) {
            (Some(name), None, None) => {
                let limit = rule
                    .limit(name)
                    .with_context(|| format!("{}: no limit {name}", rule.id))?;
                (limit.value - self.less + self.plus, limit.unit)
            }
            (None, Some(value), Some(unit)) => (value, unit),
            _ => bail!("{}: {} has a limit, or a value and a unit", rule.id, self.name),
        };
        Ok(constant(
            &self.name,
            (value, unit),
            self.rust_type.as_deref(),
            self.bare,
        ))
    }
}

impl JudgeFigure {
    /// The constant that it becomes.
    pub(super) fn constant(&self, book: &RuleBook) -> anyhow::Result<Constant> {
        let limit = book.limit(&self.limit)?;
        let unit = self.unit.unwrap_or(limit.unit);
        let value = limit
            .unit
            .convert(limit.value, unit)
            .with_context(|| format!("{} cannot be given in that unit", self.limit))?;
        let figure = (value + self.plus, unit);
        Ok(constant(&self.name, figure, self.rust_type.as_deref(), self.bare))
    }
}

fn constant(name: &str, (value, unit): (i64, Unit), rust_type: Option<&str>, bare: bool) -> Constant {
    let (ending, usual_type) = unit.in_code();
    Constant {
        name: format!("{}{}", rust_name::constant(name), if bare { "" } else { ending }),
        rust_type: rust_type.unwrap_or(usual_type).to_owned(),
        value,
        unit,
    }
}
