//! The trials together.

use core::fmt;

use serde::Serialize;

use crate::trial::LiftedTrial;

/// Shares and times over all trials.
#[derive(Debug, Serialize)]
pub(crate) struct LiftedTable {
    trials: usize,
    right: usize,
    /// Trials in which it believed for a while to be where it was not.
    misled: usize,
    /// Time of all such beliefs together, seconds.
    misled_s: u64,
    /// Until it knew its place: median and 90th percentile of all trials, seconds; none where so many never did.
    right_s: [Option<u64>; 2],
    violations: usize,
}

impl LiftedTable {
    pub(crate) fn of(trials: &[LiftedTrial]) -> Self {
        let mut times: Vec<u64> = trials.iter().filter_map(|trial| trial.right_s).collect();
        times.sort_unstable();
        let below = |share: f64| times.get((trials.len() as f64 * share) as usize).copied();
        Self {
            trials: trials.len(),
            right: times.len(),
            misled: trials.iter().filter(|trial| trial.wrong_s > 0).count(),
            misled_s: trials.iter().map(|trial| trial.wrong_s).sum(),
            right_s: [below(0.5), below(0.9)],
            violations: trials.iter().map(|trial| trial.violations).sum(),
        }
    }
}

impl fmt::Display for LiftedTable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |value: Option<u64>| value.map_or_else(|| "-".to_owned(), |value| value.to_string());
        writeln!(
            formatter,
            "trials  knew its place  s (90 %)     misled  for s  violations"
        )?;
        writeln!(
            formatter,
            "{:>6} {:>15}  {:>3} ({:>3}) {:>12} {:>6} {:>11}",
            self.trials,
            self.right,
            number(self.right_s[0]),
            number(self.right_s[1]),
            self.misled,
            self.misled_s,
            self.violations
        )
    }
}
