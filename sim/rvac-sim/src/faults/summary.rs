//! Outcomes of all trials, as a table and as JSON.

use std::fmt;

use rvac_protocol::message::Inhibit;
use serde_json::{Map, Value, json};

use super::draw::FaultKind;
use super::trial::FaultOutcome;

/// Totals over many trials.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    trials: u64,
    sim_s: f64,
    wall_s: f64,
    path_m: f64,
    faults: [u64; FaultKind::ALL.len()],
    stops: [u64; Inhibit::ALL.len()],
    violations: u64,
    failed: Vec<(u64, Vec<String>)>,
}

impl Summary {
    /// Adds up. `duration_ms` is what each trial simulated.
    #[must_use]
    pub fn of(outcomes: &[FaultOutcome], duration_ms: u64, wall_s: f64) -> Self {
        let mut summary = Self {
            trials: outcomes.len() as u64,
            sim_s: outcomes.len() as f64 * duration_ms as f64 / 1000.0,
            wall_s,
            path_m: 0.0,
            faults: [0; FaultKind::ALL.len()],
            stops: [0; Inhibit::ALL.len()],
            violations: 0,
            failed: Vec::new(),
        };
        for outcome in outcomes {
            summary.add(outcome);
        }
        summary
    }

    fn add(&mut self, outcome: &FaultOutcome) {
        self.path_m += outcome.path_m;
        for (total, count) in self.faults.iter_mut().zip(outcome.faults) {
            *total += u64::from(count);
        }
        for (total, count) in self.stops.iter_mut().zip(outcome.stops) {
            *total += u64::from(count);
        }
        self.violations += u64::from(outcome.violation_count);
        if outcome.violation_count > 0 {
            self.failed.push((outcome.seed, outcome.violations.clone()));
        }
    }

    /// Violations in all trials.
    #[must_use]
    pub const fn violations(&self) -> u64 {
        self.violations
    }

    /// The same as one JSON object.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let faults: Map<String, Value> = FaultKind::ALL
            .iter()
            .zip(self.faults)
            .map(|(kind, count)| (kind.name().to_owned(), count.into()))
            .collect();
        let stops: Map<String, Value> = Inhibit::ALL
            .iter()
            .zip(self.stops)
            .map(|(inhibit, count)| (inhibit.name().to_owned(), count.into()))
            .collect();
        json!({
            "trials": self.trials,
            "faults": self.faults.iter().sum::<u64>(),
            "faults_by_kind": faults,
            "stops_by_inhibit": stops,
            "violations": self.violations,
            "failed_seeds": self.failed.iter().map(|(seed, _)| seed).collect::<Vec<_>>(),
            "path_m": self.path_m,
            "sim_seconds": self.sim_s,
            "wall_seconds": self.wall_s,
        })
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            formatter,
            "{} trials, {:.1} simulated hours, {:.1} km, {:.0} times real time",
            self.trials,
            self.sim_s / 3600.0,
            self.path_m / 1000.0,
            self.sim_s / self.wall_s.max(1e-9),
        )?;
        writeln!(formatter, "\nfaults injected")?;
        for (kind, count) in FaultKind::ALL.iter().zip(self.faults) {
            writeln!(formatter, "  {:<16}{count:>9}", kind.name())?;
        }
        writeln!(formatter, "  {:<16}{:>9}", "all", self.faults.iter().sum::<u64>())?;
        writeln!(formatter, "\nstops by reason")?;
        for (inhibit, count) in Inhibit::ALL.iter().zip(self.stops) {
            writeln!(formatter, "  {:<16}{count:>9}", inhibit.name())?;
        }
        writeln!(formatter, "\nviolations        {:>9}", self.violations)?;
        for (seed, violations) in &self.failed {
            writeln!(formatter, "  seed {seed}:")?;
            for violation in violations {
                writeln!(formatter, "    {violation}")?;
            }
        }
        Ok(())
    }
}
