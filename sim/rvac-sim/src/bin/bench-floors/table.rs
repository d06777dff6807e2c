//! The trials together.

use core::fmt;

use serde::Serialize;

use crate::trial::{FloorsOutcome, FloorsTrial, HostMemory};

/// One line for each kind of trial.
#[derive(Debug, Serialize)]
pub(crate) struct FloorsTable {
    rows: Vec<FloorsRow>,
}

#[derive(Debug, Serialize)]
struct FloorsRow {
    kept: HostMemory,
    trials: usize,
    right: usize,
    misplaced: usize,
    wrong: usize,
    asked: usize,
    silent: usize,
    /// Until it knew: median and 90th percentile, seconds.
    known_s: [Option<f64>; 2],
    /// How far the place was off: median and largest, metres.
    off_m: [Option<f64>; 2],
}

impl FloorsTable {
    pub(crate) fn of(trials: &[FloorsTrial]) -> Self {
        let rows = HostMemory::ALL.map(|kept| FloorsRow::of(kept, trials));
        Self { rows: rows.into() }
    }
}

impl FloorsRow {
    fn of(kept: HostMemory, trials: &[FloorsTrial]) -> Self {
        let own = || trials.iter().filter(move |trial| trial.kept == kept);
        let count = |outcome: FloorsOutcome| own().filter(|trial| trial.outcome == outcome).count();
        let right = || own().filter(|trial| trial.outcome == FloorsOutcome::Right);
        let mut times: Vec<f64> = right().map(|trial| trial.time_s).collect();
        let mut offs: Vec<f64> = right().filter_map(|trial| trial.off_m).collect();
        times.sort_by(f64::total_cmp);
        offs.sort_by(f64::total_cmp);
        Self {
            kept,
            trials: own().count(),
            right: count(FloorsOutcome::Right),
            misplaced: count(FloorsOutcome::Misplaced),
            wrong: count(FloorsOutcome::Wrong),
            asked: count(FloorsOutcome::Asked),
            silent: count(FloorsOutcome::Silent),
            known_s: [share(&times, 0.5), share(&times, 0.9)],
            off_m: [share(&offs, 0.5), offs.last().copied()],
        }
    }
}

/// The value below which this share of sorted values lies.
fn share(sorted: &[f64], share: f64) -> Option<f64> {
    let place = (sorted.len() as f64 * share) as usize;
    sorted.get(place.min(sorted.len().saturating_sub(1))).copied()
}

impl fmt::Display for FloorsTable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            formatter,
            "floor    trials  right  misplaced  wrong  asked  silent  known s (90 %)   off m (most)"
        )?;
        for row in &self.rows {
            let name = match row.kept {
                HostMemory::Present => "kept",
                HostMemory::Absent => "unknown",
            };
            let number = |value: Option<f64>, digits: usize| {
                value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
            };
            writeln!(
                formatter,
                "{name:<8} {:>6} {:>6} {:>10} {:>6} {:>6} {:>7}  {:>6} ({:>5})  {:>6} ({:>5})",
                row.trials,
                row.right,
                row.misplaced,
                row.wrong,
                row.asked,
                row.silent,
                number(row.known_s[0], 0),
                number(row.known_s[1], 0),
                number(row.off_m[0], 2),
                number(row.off_m[1], 2),
            )?;
        }
        Ok(())
    }
}
