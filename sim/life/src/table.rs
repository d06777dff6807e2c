//! Medians and 90th percentiles over chains, for each run.

use std::fmt;

use rvac_sim::{FieldMeasures, Figures, MapObstacles};
use serde::{Serialize, Serializer};

use crate::LifeRun;

/// How a figure is taken from a run, and what it is called.
struct FigureRow {
    name: &'static str,
    better: Better,
    of: fn(&LifeRun) -> Option<f64>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Better {
    Less,
    More,
}

const fn less(name: &'static str, of: fn(&LifeRun) -> Option<f64>) -> FigureRow {
    FigureRow {
        name,
        better: Better::Less,
        of,
    }
}

const fn more(name: &'static str, of: fn(&LifeRun) -> Option<f64>) -> FigureRow {
    FigureRow {
        name,
        better: Better::More,
        of,
    }
}

fn figures(run: &LifeRun) -> Option<&Figures> {
    run.report.figures.as_deref()
}

fn field(run: &LifeRun) -> Option<FieldMeasures> {
    figures(run).map(|figures| figures.field)
}

fn obstacles(run: &LifeRun) -> Option<MapObstacles> {
    figures(run)?.map_obstacles
}

const ROWS: [FigureRow; 36] = [
    more("swept", |run| Some(run.report.covered)),
    less("t90_over_t0", |run| figures(run)?.t90_over_t0),
    less("t95_over_t0", |run| figures(run)?.t95_over_t0),
    less("job_over_t0", |run| figures(run)?.job_over_t0),
    less("bumps", |run| Some(f64::from(run.report.bumps))),
    less("bumps_per_m2", |run| Some(figures(run)?.bumps_per_m2)),
    less("place_median_m", |run| figures(run)?.pose_error_median_m),
    less("place_p90_m", |run| figures(run)?.pose_error_p90_m),
    less("place_median_aligned_m", |run| {
        figures(run)?.pose_error_median_aligned_m
    }),
    less("place_p90_aligned_m", |run| {
        figures(run)?.pose_error_p90_aligned_m
    }),
    less("sigma_median_m", |run| figures(run)?.sigma_median_m),
    less("nees_place", |run| figures(run)?.nees_place),
    less("nees_place_aligned", |run| figures(run)?.nees_place_aligned),
    less("nees_heading", |run| figures(run)?.nees_heading),
    less("lost_s", |run| Some(figures(run)?.lost_seconds)),
    less("unnoticed_wrong_s", |run| Some(figures(run)?.lost_unnoticed_s)),
    less("told_minus_true", |run| {
        figures(run)?.told_minus_true.map(f64::abs)
    }),
    more("map_iou", |run| figures(run)?.map_iou),
    more("map_iou_aligned", |run| figures(run)?.map_iou_aligned),
    less("wall_error_m", |run| figures(run)?.wall_error_m),
    less("wall_error_aligned_m", |run| figures(run)?.wall_error_aligned_m),
    less("false_obstacle_m2", |run| Some(obstacles(run)?.false_m2)),
    less("false_obstacles", |run| {
        Some(f64::from(obstacles(run)?.false_count))
    }),
    less("missing_obstacle_m2", |run| Some(obstacles(run)?.missing_m2)),
    less("missing_obstacles", |run| {
        Some(f64::from(obstacles(run)?.missing_count))
    }),
    less("map_bytes", |run| run.map_bytes.map(|bytes| bytes as f64)),
    less("minutes_per_room", |run| field(run)?.minutes_per_room),
    less("collisions_per_m2", |run| Some(field(run)?.collisions_per_m2)),
    less("swept_twice", |run| Some(field(run)?.swept_twice)),
    more("path_efficiency", |run| field(run)?.path_efficiency),
    more("docked", |run| Some(f64::from(u8::from(figures(run)?.docked)))),
    less("violations", |run| Some(f64::from(run.report.monitor_violations))),
    less("load_step_max_ms", |run| Some(run.timing?.load_step_max_ms)),
    less("save_step_max_ms", |run| Some(run.timing?.save_step_max_ms)),
    less("write_max_ms", |run| Some(run.timing?.write_max_ms)),
    more("times_real_time", |run| Some(run.timing?.times_real_time)),
];

/// A figure over the chains.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
struct Spread {
    /// `null` = the median chain has no such figure.
    median: Option<f64>,
    /// The 90th percentile toward the worse.
    p90: Option<f64>,
    /// Chains without the figure.
    missing: usize,
}

/// All runs of some chains, by their number.
#[derive(Clone, Debug)]
pub struct LifeTable {
    /// For each run the figures in the order of the rows.
    days: Vec<Vec<Spread>>,
    chains: usize,
}

impl LifeTable {
    /// Of chains of runs.
    #[must_use]
    pub fn of(chains: &[Vec<LifeRun>]) -> Self {
        let longest = chains.iter().map(Vec::len).max().unwrap_or(0);
        let day = |number: usize| {
            let runs: Vec<&LifeRun> = chains.iter().filter_map(|chain| chain.get(number)).collect();
            let row = |row: &FigureRow| {
                let values: Vec<Option<f64>> = runs.iter().map(|run| (row.of)(run)).collect();
                spread(&values, row.better)
            };
            ROWS.iter().map(row).collect()
        };
        Self {
            days: (0..longest).map(day).collect(),
            chains: chains.len(),
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

impl Serialize for LifeTable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.days.iter().zip(1..).map(|(day, run): (_, u32)| {
            let named = ROWS.iter().zip(day);
            let mut figures: serde_json::Map<String, serde_json::Value> = named
                .filter(|(_, spread)| spread.missing < self.chains)
                .map(|(row, spread)| (row.name.to_owned(), serde_json::json!(spread)))
                .collect();
            figures.insert("run".to_owned(), run.into());
            figures
        }))
    }
}

impl fmt::Display for LifeTable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:<24}", "run")?;
        for run in 1..=self.days.len() {
            write!(formatter, " {run:>16}")?;
        }
        writeln!(formatter)?;
        for (number, row) in ROWS.iter().enumerate() {
            let spreads: Vec<&Spread> = self.days.iter().filter_map(|day| day.get(number)).collect();
            if spreads.iter().all(|spread| spread.missing == self.chains) {
                continue;
            }
            write!(formatter, "{:<24}", row.name)?;
            for spread in spreads {
                write!(formatter, " {:>16}", spread.text())?;
            }
            writeln!(formatter)?;
        }
        Ok(())
    }
}

impl Spread {
    fn text(self) -> String {
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
    fn a_chain_without_the_figure_counts_as_the_worst() {
        let times: Vec<Option<f64>> = (1..=8).map(|n| Some(f64::from(n))).chain([None, None]).collect();
        let found = spread(&times, Better::Less);
        assert_eq!((found.median, found.p90, found.missing), (Some(5.0), None, 2));
        let shares: Vec<Option<f64>> = (1..=10).map(|n| Some(f64::from(n) / 10.0)).collect();
        assert_eq!(spread(&shares, Better::More).p90, Some(0.2));
    }
}
