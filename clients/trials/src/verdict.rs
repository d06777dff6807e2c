//! What a trial has seen.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;

/// A peer, and what came of its checks.
#[derive(Debug, Serialize)]
pub(crate) struct Verdict {
    name: &'static str,
    version: String,
    checks: Vec<String>,
    failed: Vec<String>,
    /// What was measured on the way.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    figures: BTreeMap<&'static str, f64>,
}

impl Verdict {
    pub(crate) fn of(name: &'static str) -> Self {
        Self {
            name,
            version: "unknown".to_owned(),
            checks: Vec::new(),
            failed: Vec::new(),
            figures: BTreeMap::new(),
        }
    }

    /// The version of the peer, once it is known.
    pub(crate) fn version(&mut self, version: Option<&str>) {
        if let Some(version) = version {
            version.clone_into(&mut self.version);
        }
    }

    /// The trial did not come to its end.
    pub(crate) fn ended_early(&mut self, error: &anyhow::Error) {
        self.failed.push(format!("the trial ended early: {error:#}"));
    }

    /// A check passes or fails; an error says why.
    pub(crate) fn check(&mut self, what: &str, result: anyhow::Result<()>) {
        eprintln!("    {} {what}", if result.is_ok() { "ok  " } else { "FAIL" });
        match result {
            Ok(()) => self.checks.push(what.to_owned()),
            Err(error) => self.failed.push(format!("{what}: {error:#}")),
        }
    }

    /// A check passes if it is so; otherwise what was told says why not.
    pub(crate) fn holds(&mut self, what: &str, is_so: bool, told: &impl fmt::Display) {
        let result = if is_so {
            Ok(())
        } else {
            Err(anyhow::anyhow!("{told}"))
        };
        self.check(what, result);
    }

    pub(crate) fn figure(&mut self, name: &'static str, value: f64) {
        self.figures.insert(name, (value * 1000.0).round() / 1000.0);
    }

    pub(crate) fn failures(&self) -> usize {
        self.failed.len()
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (checks, failed) = (self.checks.len(), self.failed.len());
        write!(
            to,
            "{:16} {:12} {checks:3} checks, {failed} failed",
            self.name, self.version
        )?;
        for (name, value) in &self.figures {
            write!(to, "\n    {name}: {value}")?;
        }
        for failure in &self.failed {
            write!(to, "\n    FAILED {failure}")?;
        }
        Ok(())
    }
}
