//! The worst figures of the last long run, as protocol/measured.toml keeps them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::campaign::TrialSummary;
use crate::catalog::trials;

/// A figure may be worse than what is printed by so much of it, but by so many milliseconds at least: other phases are
/// drawn when a firmware changes.
const WORSE_SHARE: f64 = 0.05;
const WORSE_MS: f64 = 2.0;

const HEAD: &str = "\
# Worst figures of the last long run, in milliseconds: `cargo xtask bench safety --long --write`. SAFETY.md prints them beside
# the limits of rules.toml. `cargo xtask bench safety --check` fails when one gets worse. Do not edit.

";

/// Why there are no figures.
#[derive(Debug, thiserror::Error)]
pub enum MeasuredError {
    /// The file cannot be read or written.
    #[error("{}: {error}", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        error: std::io::Error,
    },
    /// It is no such file.
    #[error("{}: {message}", .path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
}

/// The figures.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measured {
    /// Of cordlib's tests, by limit.
    #[serde(default)]
    pub tests: BTreeMap<String, f64>,
    /// Of the trials, in their order.
    #[serde(rename = "trial", default)]
    pub trials: Vec<MeasuredTrial>,
}

/// One trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct MeasuredTrial {
    /// Its name in rules.toml.
    pub name: String,
    /// Its rule.
    pub rule: String,
    /// What happens.
    pub what: String,
    /// Name of the limit.
    pub limit: String,
    /// What an observer adds to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub allowance: Option<String>,
    /// Moments that were tried.
    pub phases: usize,
    /// Worst reaction, ms.
    pub worst_ms: f64,
}

impl Measured {
    /// Reads the file; there are no figures if there is none.
    ///
    /// # Errors
    /// See [`MeasuredError`].
    pub fn read(path: &Path) -> Result<Self, MeasuredError> {
        let text = match std::fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => {
                return Err(MeasuredError::File {
                    path: path.to_owned(),
                    error,
                });
            }
        };
        toml::from_str(&text).map_err(|error| MeasuredError::Format {
            path: path.to_owned(),
            message: error.to_string(),
        })
    }

    /// Writes the file.
    ///
    /// # Errors
    /// See [`MeasuredError`].
    pub fn write(&self, path: &Path) -> Result<(), MeasuredError> {
        let text = toml::to_string(self).map_err(|error| MeasuredError::Format {
            path: path.to_owned(),
            message: error.to_string(),
        })?;
        std::fs::write(path, format!("{HEAD}{text}")).map_err(|error| MeasuredError::File {
            path: path.to_owned(),
            error,
        })
    }

    /// Takes over a trial's new figure, in its place or at the end.
    pub fn renew(&mut self, summary: &TrialSummary) {
        let Some(worst_ms) = summary.worst_ms else {
            return;
        };
        let renewed = MeasuredTrial {
            name: summary.name.to_owned(),
            rule: summary.rule.to_owned(),
            what: summary.what.to_owned(),
            limit: summary.limit.to_owned(),
            allowance: summary.allowance.map(str::to_owned),
            phases: summary.phases,
            worst_ms: round(worst_ms),
        };
        match self.trials.iter_mut().find(|known| known.name == renewed.name) {
            Some(known) => *known = renewed,
            None => self.trials.push(renewed),
        }
        let order: Vec<&str> = trials().iter().map(|trial| trial.name).collect();
        self.trials
            .sort_by_key(|known| order.iter().position(|name| *name == known.name));
        self.trials.retain(|known| order.contains(&known.name.as_str()));
    }

    /// What is worse than it was by more than chance explains.
    #[must_use]
    pub fn complaint(&self, summary: &TrialSummary) -> Option<String> {
        let known = self.trials.iter().find(|known| known.name == summary.name);
        worse(summary.name, known.map(|known| known.worst_ms), summary.worst_ms)
    }

    /// The same of a figure that cordlib's tests print.
    #[must_use]
    pub fn complaint_of_tests(&self, limit: &str, worst_ms: f64) -> Option<String> {
        worse(limit, self.tests.get(limit).copied(), Some(worst_ms))
    }
}

fn worse(name: &str, known_ms: Option<f64>, now_ms: Option<f64>) -> Option<String> {
    let Some(known_ms) = known_ms else {
        return Some(format!("{name} was never measured"));
    };
    let bound_ms = known_ms + (known_ms * WORSE_SHARE).max(WORSE_MS);
    match now_ms {
        Some(now_ms) if now_ms <= bound_ms => None,
        Some(now_ms) => Some(format!(
            "{name} took {now_ms:.1} ms, {known_ms:.1} ms are printed"
        )),
        None => Some(format!("{name} had no reaction")),
    }
}

/// To a tenth of a millisecond, upward.
fn round(ms: f64) -> f64 {
    (ms * 10.0).ceil() / 10.0
}

#[cfg(test)]
mod tests {
    use super::Measured;
    use crate::campaign::TrialSummary;

    fn summary(worst_ms: Option<f64>) -> TrialSummary {
        TrialSummary {
            name: "button",
            rule: "S28",
            what: "button",
            limit: "S28.stop",
            allowance: None,
            phases: 200,
            spread_ms: 1_000,
            worst_ms,
            mean_ms: 1.0,
            limit_ms: 50,
            broken: 0,
            violations: 0,
            said: Vec::new(),
        }
    }

    #[test]
    fn a_figure_that_gets_worse_is_named_and_chance_is_not() {
        let mut measured = Measured::default();
        assert!(
            measured.complaint(&summary(Some(1.0))).is_some(),
            "never measured"
        );
        measured.renew(&summary(Some(100.02)));
        assert_eq!(measured.trials[0].worst_ms, 100.1);
        assert_eq!(measured.complaint(&summary(Some(104.0))), None);
        assert!(measured.complaint(&summary(Some(106.0))).is_some());
        assert!(measured.complaint(&summary(None)).is_some());
        measured.renew(&summary(Some(3.0)));
        assert_eq!(measured.trials.len(), 1);
        assert_eq!(measured.complaint(&summary(Some(5.0))), None);
    }

    #[test]
    fn figures_are_read_as_they_were_written() {
        let mut measured = Measured::default();
        measured.tests.insert("S6.stop".to_owned(), 1.0);
        measured.renew(&summary(Some(11.2)));
        let text = toml::to_string(&measured).unwrap();
        assert_eq!(toml::from_str::<Measured>(&text).unwrap(), measured);
    }
}
