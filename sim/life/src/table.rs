//! Medians and 90th percentiles over chains, for each run.

use std::fmt;

use rvac_sim::bench::{RunFigure, Spread};
use rvac_sim::{FieldMeasures, Figures, MapObstacles};
use serde::{Serialize, Serializer};

use crate::LifeRun;

fn figures(run: &LifeRun) -> Option<&Figures> {
    run.report.figures.as_deref()
}

fn field(run: &LifeRun) -> Option<FieldMeasures> {
    figures(run).map(|figures| figures.field)
}

fn obstacles(run: &LifeRun) -> Option<MapObstacles> {
    figures(run)?.map_obstacles
}

const ROWS: [RunFigure<LifeRun>; 38] = [
    RunFigure::more("swept", |run| Some(run.report.covered)),
    RunFigure::less("t90_over_t0", |run| figures(run)?.t90_over_t0),
    RunFigure::less("t95_over_t0", |run| figures(run)?.t95_over_t0),
    RunFigure::less("job_over_t0", |run| figures(run)?.job_over_t0),
    RunFigure::less("bumps", |run| Some(f64::from(run.report.bumps))),
    RunFigure::less("bumps_per_m2", |run| Some(figures(run)?.bumps_per_m2)),
    RunFigure::less("place_median_m", |run| figures(run)?.pose_error_median_m),
    RunFigure::less("place_p90_m", |run| figures(run)?.pose_error_p90_m),
    RunFigure::less("place_median_aligned_m", |run| {
        figures(run)?.pose_error_median_aligned_m
    }),
    RunFigure::less("place_p90_aligned_m", |run| {
        figures(run)?.pose_error_p90_aligned_m
    }),
    RunFigure::less("sigma_median_m", |run| figures(run)?.sigma_median_m),
    RunFigure::less("nees_place", |run| figures(run)?.nees_place),
    RunFigure::less("nees_place_aligned", |run| figures(run)?.nees_place_aligned),
    RunFigure::less("nees_place_median_aligned", |run| {
        figures(run)?.nees_place_median_aligned
    }),
    RunFigure::less("nees_heading", |run| figures(run)?.nees_heading),
    RunFigure::less("lost_s", |run| Some(figures(run)?.lost_seconds)),
    RunFigure::less("unnoticed_wrong_s", |run| Some(figures(run)?.lost_unnoticed_s)),
    RunFigure::less("told_minus_true", |run| {
        figures(run)?.told_minus_true.map(f64::abs)
    }),
    RunFigure::more("map_iou", |run| figures(run)?.map_iou),
    RunFigure::more("map_iou_aligned", |run| figures(run)?.map_iou_aligned),
    RunFigure::less("wall_error_m", |run| figures(run)?.wall_error_m),
    RunFigure::less("wall_error_aligned_m", |run| figures(run)?.wall_error_aligned_m),
    RunFigure::less("false_obstacle_m2", |run| Some(obstacles(run)?.false_m2)),
    RunFigure::less("false_obstacles", |run| {
        Some(f64::from(obstacles(run)?.false_count))
    }),
    RunFigure::less("missing_obstacle_m2", |run| Some(obstacles(run)?.missing_m2)),
    RunFigure::less("missing_obstacles", |run| {
        Some(f64::from(obstacles(run)?.missing_count))
    }),
    RunFigure::less("map_bytes", |run| run.map_bytes.map(|bytes| bytes as f64)),
    RunFigure::less("minutes_per_room", |run| field(run)?.minutes_per_room),
    RunFigure::less("collisions_per_m2", |run| Some(field(run)?.collisions_per_m2)),
    RunFigure::less("swept_twice", |run| Some(field(run)?.swept_twice)),
    RunFigure::more("path_efficiency", |run| field(run)?.path_efficiency),
    RunFigure::more("docked", |run| Some(f64::from(u8::from(figures(run)?.docked)))),
    RunFigure::less("violations", |run| Some(f64::from(run.report.monitor_violations))),
    RunFigure::less("load_step_max_ms", |run| Some(run.timing?.load_step_max_ms)),
    RunFigure::less("save_step_max_ms", |run| Some(run.timing?.save_step_max_ms)),
    RunFigure::less("shutdown_ms", |run| Some(run.timing?.shutdown_ms)),
    RunFigure::less("write_max_ms", |run| Some(run.timing?.write_max_ms)),
    RunFigure::more("times_real_time", |run| Some(run.timing?.times_real_time)),
];

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
            ROWS.iter().map(|row| row.spread(&runs)).collect()
        };
        Self {
            days: (0..longest).map(day).collect(),
            chains: chains.len(),
        }
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
