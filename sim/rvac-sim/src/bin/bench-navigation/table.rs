//! Medians and 90th percentiles of each mode.

use std::fmt;

use serde::{Serialize, Serializer};

use crate::lost::LostShares;
use crate::mode::CleaningMode;
use crate::run::NavigationRun;

/// A figure over all runs of a mode.
#[derive(Clone, Debug, Serialize)]
struct Spread {
    /// `null` = the median run did not get so far.
    median: Option<f64>,
    /// The 90th percentile toward the worse.
    p90: Option<f64>,
    /// Runs without the figure.
    missing: usize,
}

/// How a figure is taken from a run, and what it is called.
struct FigureColumn {
    name: &'static str,
    better: Better,
    of: fn(&NavigationRun) -> Option<f64>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Better {
    Less,
    More,
}

const FIGURES: [FigureColumn; 38] = [
    less("t80_over_t0", |run| run.figures.t80_over_t0),
    less("t90_over_t0", |run| run.figures.t90_over_t0),
    less("t95_over_t0", |run| run.figures.t95_over_t0),
    more("share_at_t0", |run| run.figures.share_at_t0),
    more("share_at_1_8_t0", |run| run.figures.share_at_1_8_t0),
    more("covered", |run| Some(run.covered)),
    less("job_over_t0", |run| run.figures.job_over_t0),
    less("away_s", |run| run.figures.away_s),
    less("turn_deg_per_m2", |run| Some(run.figures.turn_deg_per_m2)),
    less("bumps_per_m2", |run| Some(run.figures.bumps_per_m2)),
    less("minutes_per_room", |run| run.figures.field.minutes_per_room),
    less("swept_twice", |run| Some(run.figures.field.swept_twice)),
    more("path_efficiency", |run| run.figures.field.path_efficiency),
    less("pose_rmse_10_min_m", |run| run.figures.pose_rmse_10_min_m),
    less("pose_rmse_30_min_m", |run| run.figures.pose_rmse_30_min_m),
    less("pose_rmse_60_min_m", |run| run.figures.pose_rmse_60_min_m),
    less("pose_rmse_120_min_m", |run| run.figures.pose_rmse_120_min_m),
    less("pose_rmse_aligned_m", |run| run.figures.pose_rmse_aligned_m),
    less("heading_rmse_deg", |run| run.figures.heading_rmse_deg),
    less("lost_seconds", |run| Some(run.figures.lost_seconds)),
    less("lost_unnoticed_s", |run| Some(run.figures.lost_unnoticed_s)),
    less("lost_unnoticed_aligned_s", |run| {
        Some(run.figures.lost_unnoticed_aligned_s)
    }),
    less("lost_false_alarm_s", |run| Some(run.figures.lost_false_alarm_s)),
    more("map_iou", |run| run.figures.map_iou),
    more("map_iou_aligned", |run| run.figures.map_iou_aligned),
    less("wall_error_m", |run| run.figures.wall_error_m),
    less("wall_error_aligned_m", |run| run.figures.wall_error_aligned_m),
    more("carpet_recall", |run| run.figures.carpet_recall),
    more("carpet_precision", |run| run.figures.carpet_precision),
    less("estimate_error", |run| run.figures.estimate_error.map(f64::abs)),
    more("docked", |run| Some(f64::from(u8::from(run.figures.docked)))),
    less("stuck", |run| Some(f64::from(run.stuck))),
    less("foot_contacts", |run| Some(f64::from(run.foot_contacts))),
    less("foot_pushed_max_ms", |run| {
        Some(f64::from(run.foot_pushed_max_ms))
    }),
    less("violations", |run| Some(f64::from(run.violations))),
    less("host_step_max_us", |run| Some(run.host_cost.step_max_us)),
    less("host_s_per_hour", |run| {
        Some(run.host_cost.processor_s * 3600.0 / run.sim_seconds)
    }),
    more("times_real_time", |run| Some(run.sim_seconds / run.wall_seconds)),
];

const fn less(name: &'static str, of: fn(&NavigationRun) -> Option<f64>) -> FigureColumn {
    FigureColumn {
        name,
        better: Better::Less,
        of,
    }
}

const fn more(name: &'static str, of: fn(&NavigationRun) -> Option<f64>) -> FigureColumn {
    FigureColumn {
        name,
        better: Better::More,
        of,
    }
}

/// All modes side by side; where several runs follow each other in a home, the first, the second and so on apart.
pub(crate) struct NavigationTable {
    columns: Vec<Column>,
}

struct Column {
    name: String,
    runs: usize,
    spreads: Vec<Spread>,
    lost: LostShares,
}

impl NavigationTable {
    pub(crate) fn of(runs: &[NavigationRun], modes: &[CleaningMode]) -> Self {
        let columns = modes
            .iter()
            .flat_map(|mode| (1..=mode.rounds()).map(|round| Column::of(runs, *mode, round)));
        Self {
            columns: columns.collect(),
        }
    }
}

impl Column {
    fn of(runs: &[NavigationRun], mode: CleaningMode, round: u32) -> Self {
        let runs: Vec<&NavigationRun> = runs
            .iter()
            .filter(|run| (run.mode, run.round) == (mode, round))
            .collect();
        let spreads = FIGURES.iter().map(|figure| {
            let values: Vec<_> = runs.iter().map(|run| (figure.of)(run)).collect();
            spread(&values, figure.better)
        });
        let name = match mode.rounds() {
            1 => mode.name().to_owned(),
            _ => format!("{}-{round}", mode.name()),
        };
        Self {
            name,
            runs: runs.len(),
            spreads: spreads.collect(),
            lost: LostShares::of(runs.iter().map(|run| run.figures.lost_stretches.as_slice())),
        }
    }
}

/// Nearest rank; a run without the figure is worse than all others.
fn spread(values: &[Option<f64>], better: Better) -> Spread {
    let mut sorted: Vec<f64> = values.iter().flatten().copied().collect();
    sorted.sort_by(f64::total_cmp);
    if better == Better::More {
        sorted.reverse();
    }
    let rank = |share: f64| {
        let rank = (share * values.len() as f64).ceil() as usize;
        rank.checked_sub(1).and_then(|index| sorted.get(index)).copied()
    };
    Spread {
        median: rank(0.5),
        p90: rank(0.9),
        missing: values.len() - sorted.len(),
    }
}

impl Serialize for NavigationTable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.columns.iter().map(|column| {
            let figures: serde_json::Map<String, serde_json::Value> = FIGURES
                .iter()
                .zip(&column.spreads)
                .map(|(figure, spread)| (figure.name.to_owned(), serde_json::json!(spread)))
                .chain([
                    ("runs".to_owned(), column.runs.into()),
                    ("lost".to_owned(), serde_json::json!(column.lost)),
                ])
                .collect();
            (&column.name, figures)
        }))
    }
}

impl fmt::Display for NavigationTable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.row(formatter, "", |column| column.name.clone())?;
        self.row(formatter, "lower bound (T0)", |_| "1.00".to_owned())?;
        for (number, figure) in FIGURES.iter().enumerate() {
            self.row(formatter, figure.name, |column| {
                column.spreads.get(number).map_or_else(String::new, Spread::text)
            })?;
        }
        let share = |share: Option<f64>| share.map_or_else(|| "-".to_owned(), |share| format!("{share:.3}"));
        self.row(formatter, "runs ever lost", |column| share(column.lost.runs_lost))?;
        self.row(formatter, "lost stretches", |column| {
            column.lost.stretches.to_string()
        })?;
        self.row(formatter, "ended in 180 s", |column| {
            share(column.lost.found_in_180_s)
        })
    }
}

impl NavigationTable {
    fn row(
        &self,
        formatter: &mut fmt::Formatter<'_>,
        name: &str,
        text: impl Fn(&Column) -> String,
    ) -> fmt::Result {
        write!(formatter, "{name:<24}")?;
        for column in &self.columns {
            write!(formatter, " {:>18}", text(column))?;
        }
        writeln!(formatter)
    }
}

impl Spread {
    fn text(&self) -> String {
        let number = |value: Option<f64>| match value {
            None => "-".to_owned(),
            Some(value) if value.abs() >= 100.0 => format!("{value:.0}"),
            Some(value) if value.abs() >= 1.0 => format!("{value:.2}"),
            Some(value) => format!("{value:.3}"),
        };
        format!("{} ({})", number(self.median), number(self.p90))
    }
}

#[cfg(test)]
mod tests {
    use super::{Better, spread};

    #[test]
    fn runs_that_did_not_arrive_count_as_the_worst() {
        let times: Vec<Option<f64>> = (1..=8).map(|n| Some(f64::from(n))).chain([None, None]).collect();
        let spread_of_times = spread(&times, Better::Less);
        assert_eq!(spread_of_times.median, Some(5.0));
        assert_eq!((spread_of_times.p90, spread_of_times.missing), (None, 2));
        let shares: Vec<Option<f64>> = (1..=10).map(|n| Some(f64::from(n) / 10.0)).collect();
        assert_eq!(spread(&shares, Better::More).p90, Some(0.2));
        assert_eq!(spread(&[], Better::Less).median, None);
    }
}
