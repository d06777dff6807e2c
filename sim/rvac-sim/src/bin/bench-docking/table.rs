//! Shares, medians and 90th percentiles of each situation.

use std::fmt;

use serde::Serialize;

use crate::run::{DockingRun, DockingStart};

/// The figures of a situation.
#[derive(Clone, Debug, Serialize)]
struct DockingRow {
    situation: DockingStart,
    runs: usize,
    docked: usize,
    share: f64,
    time_median_s: Option<f64>,
    time_p90_s: Option<f64>,
    /// Of the runs that began at most 2 m from the dock.
    near_time_median_s: Option<f64>,
    aside_median_m: Option<f64>,
    aside_p90_m: Option<f64>,
    turned_median_deg: Option<f64>,
    turned_p90_deg: Option<f64>,
    violations: usize,
}

/// A row for each situation.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct DockingTable(Vec<DockingRow>);

const NEAR_M: f64 = 2.0;

impl DockingTable {
    pub(crate) fn of(runs: &[DockingRun], situations: &[DockingStart]) -> Self {
        Self(
            situations
                .iter()
                .map(|situation| DockingRow::of(runs, *situation))
                .collect(),
        )
    }
}

impl DockingRow {
    fn of(runs: &[DockingRun], situation: DockingStart) -> Self {
        let all: Vec<&DockingRun> = runs.iter().filter(|run| run.situation == situation).collect();
        let docked: Vec<&DockingRun> = all.iter().copied().filter(|run| run.docked).collect();
        let of_docked =
            |figure: fn(&DockingRun) -> f64| docked.iter().copied().map(figure).collect::<Vec<_>>();
        // A robot that did not come home needed for ever.
        let times: Vec<f64> = all
            .iter()
            .map(|run| if run.docked { run.time_s } else { f64::INFINITY })
            .collect();
        let near: Vec<f64> = all
            .iter()
            .zip(&times)
            .filter(|(run, _)| run.distance_m <= NEAR_M)
            .map(|(_, time_s)| *time_s)
            .collect();
        let asides = of_docked(|run| run.aside_m);
        let turns = of_docked(|run| run.turned_deg);
        Self {
            situation,
            runs: all.len(),
            docked: docked.len(),
            share: docked.len() as f64 / all.len().max(1) as f64,
            time_median_s: rank(&times, 0.5),
            time_p90_s: rank(&times, 0.9),
            near_time_median_s: rank(&near, 0.5),
            aside_median_m: rank(&asides, 0.5),
            aside_p90_m: rank(&asides, 0.9),
            turned_median_deg: rank(&turns, 0.5),
            turned_p90_deg: rank(&turns, 0.9),
            violations: all.iter().map(|run| run.violations).sum(),
        }
    }
}

/// Nearest rank; `None` for what is not finite, or of nothing.
fn rank(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = (share * values.len() as f64).ceil() as usize;
    let value = place.checked_sub(1).and_then(|index| sorted.get(index)).copied();
    value.filter(|value| value.is_finite())
}

impl fmt::Display for DockingTable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            formatter,
            "{:<10} {:>5} {:>7} {:>7} {:>16} {:>12} {:>18} {:>16} {:>10}",
            "from",
            "runs",
            "docked",
            "share",
            "s median (p90)",
            "s from 2 m",
            "mm aside (p90)",
            "deg (p90)",
            "violations"
        )?;
        let text = |value: Option<f64>, scale: f64| {
            value.map_or_else(|| "-".to_owned(), |value| format!("{:.1}", scale * value))
        };
        for row in &self.0 {
            let pair = |median, p90, scale| format!("{} ({})", text(median, scale), text(p90, scale));
            writeln!(
                formatter,
                "{:<10} {:>5} {:>7} {:>7.3} {:>16} {:>12} {:>18} {:>16} {:>10}",
                row.situation.name(),
                row.runs,
                row.docked,
                row.share,
                pair(row.time_median_s, row.time_p90_s, 1.0),
                text(row.near_time_median_s, 1.0),
                pair(row.aside_median_m, row.aside_p90_m, 1000.0),
                pair(row.turned_median_deg, row.turned_p90_deg, 1.0),
                row.violations
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::rank;

    #[test]
    fn ranks_are_of_all_and_those_who_never_came_are_last() {
        let times = [3.0, 1.0, 2.0, f64::INFINITY];
        assert_eq!(rank(&times, 0.5), Some(2.0));
        assert_eq!(rank(&times, 0.9), None);
        assert_eq!(rank(&[], 0.5), None);
    }
}
