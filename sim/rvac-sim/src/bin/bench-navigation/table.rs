//! Medians and 90th percentiles of each mode.

use std::fmt;

use rvac_sim::bench::{RunFigure, Spread};
use serde::{Serialize, Serializer};

use crate::lost::LostShares;
use crate::mode::CleaningMode;
use crate::run::NavigationRun;

const FIGURES: [RunFigure<NavigationRun>; 49] = [
    RunFigure::less("t80_over_t0", |run| run.figures.t80_over_t0),
    RunFigure::less("t90_over_t0", |run| run.figures.t90_over_t0),
    RunFigure::less("t95_over_t0", |run| run.figures.t95_over_t0),
    RunFigure::more("share_at_t0", |run| run.figures.share_at_t0),
    RunFigure::more("share_at_1_8_t0", |run| run.figures.share_at_1_8_t0),
    RunFigure::more("covered", |run| Some(run.covered)),
    RunFigure::less("job_over_t0", |run| run.figures.job_over_t0),
    RunFigure::less("away_s", |run| run.figures.away_s),
    RunFigure::less("turn_deg_per_m2", |run| Some(run.figures.turn_deg_per_m2)),
    RunFigure::less("bumps_per_m2", |run| Some(run.figures.bumps_per_m2)),
    RunFigure::less("cruise_over_t0", |run| {
        Some(run.figures.time_spent.cruise_s / run.t0_s)
    }),
    RunFigure::less("slow_over_t0", |run| {
        Some(run.figures.time_spent.slow_s / run.t0_s)
    }),
    RunFigure::less("arc_over_t0", |run| Some(run.figures.time_spent.arc_s / run.t0_s)),
    RunFigure::less("spot_turn_over_t0", |run| {
        Some(run.figures.time_spent.spot_turn_s / run.t0_s)
    }),
    RunFigure::less("back_over_t0", |run| {
        Some(run.figures.time_spent.back_s / run.t0_s)
    }),
    RunFigure::less("still_over_t0", |run| {
        Some(run.figures.time_spent.still_s / run.t0_s)
    }),
    RunFigure::less("contact_over_t0", |run| {
        Some(run.figures.time_spent.contact_s / run.t0_s)
    }),
    RunFigure::less("again_over_t0", |run| {
        Some(run.figures.time_spent.again_s / run.t0_s)
    }),
    RunFigure::less("nees_place", |run| run.figures.nees_place),
    RunFigure::less("nees_heading", |run| run.figures.nees_heading),
    RunFigure::less("minutes_per_room", |run| run.figures.field.minutes_per_room),
    RunFigure::less("swept_twice", |run| Some(run.figures.field.swept_twice)),
    RunFigure::more("path_efficiency", |run| run.figures.field.path_efficiency),
    RunFigure::less("pose_rmse_m", |run| run.pose_rmse_m),
    RunFigure::less("pose_rmse_10_min_m", |run| run.figures.pose_rmse_10_min_m),
    RunFigure::less("pose_rmse_30_min_m", |run| run.figures.pose_rmse_30_min_m),
    RunFigure::less("pose_rmse_60_min_m", |run| run.figures.pose_rmse_60_min_m),
    RunFigure::less("pose_rmse_120_min_m", |run| run.figures.pose_rmse_120_min_m),
    RunFigure::less("pose_rmse_aligned_m", |run| run.figures.pose_rmse_aligned_m),
    RunFigure::less("heading_rmse_deg", |run| run.figures.heading_rmse_deg),
    RunFigure::less("lost_seconds", |run| Some(run.figures.lost_seconds)),
    RunFigure::less("lost_unnoticed_s", |run| Some(run.figures.lost_unnoticed_s)),
    RunFigure::less("lost_unnoticed_aligned_s", |run| {
        Some(run.figures.lost_unnoticed_aligned_s)
    }),
    RunFigure::less("lost_false_alarm_s", |run| Some(run.figures.lost_false_alarm_s)),
    RunFigure::more("map_iou", |run| run.figures.map_iou),
    RunFigure::more("map_iou_aligned", |run| run.figures.map_iou_aligned),
    RunFigure::less("wall_error_m", |run| run.figures.wall_error_m),
    RunFigure::less("wall_error_aligned_m", |run| run.figures.wall_error_aligned_m),
    RunFigure::more("carpet_recall", |run| run.figures.carpet_recall),
    RunFigure::more("carpet_precision", |run| run.figures.carpet_precision),
    RunFigure::less("estimate_error", |run| run.figures.estimate_error.map(f64::abs)),
    RunFigure::more("docked", |run| Some(f64::from(u8::from(run.figures.docked)))),
    RunFigure::less("stuck", |run| Some(f64::from(run.stuck))),
    RunFigure::less("foot_contacts", |run| Some(f64::from(run.foot_contacts))),
    RunFigure::less("foot_pushed_max_ms", |run| {
        Some(f64::from(run.foot_pushed_max_ms))
    }),
    RunFigure::less("violations", |run| Some(f64::from(run.violations))),
    RunFigure::less("host_step_max_us", |run| Some(run.host_cost.step_max_us)),
    RunFigure::less("host_s_per_hour", |run| {
        Some(run.host_cost.processor_s * 3600.0 / run.sim_seconds)
    }),
    RunFigure::more("times_real_time", |run| Some(run.sim_seconds / run.wall_seconds)),
];

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
        let spreads = FIGURES.iter().map(|figure| figure.spread(&runs));
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
