//! `bench-plan`: how soon an ideal robot sweeps a known home by the plan of `systematic`. The robot drives the plan without
//! error at cruise speed and turns at its turn rate, with no time to speed up; so only the planner is measured.
#![forbid(unsafe_code)]

#[path = "../progress.rs"]
mod progress;

use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::Instant;

use brain::coverage::plan::{CoveragePlan, Departure, PlanSettings, plan_pattern};
use brain::{CELL_M, Cell, Pattern, Pose2, Raster};
use clap::{Parser, ValueEnum};
use home::{Home, RobotModel};
use progress::Progress;
use serde::Serialize;

/// How often a plan is made; the fastest counts.
const TRIES: u32 = 5;
/// Distance between two places at which the ideal robot sweeps, metres.
const STEP_M: f64 = 0.01;

/// Measures plans.
#[derive(Debug, Parser)]
struct Arguments {
    /// Home: a ROS map .yaml, a Valetudo map .json, or a home .toml; may be given several times.
    #[arg(long, required = true)]
    home: Vec<PathBuf>,
    /// Robot model by name.
    #[arg(long, default_value = "sr8730")]
    robot: String,
    /// Standard deviation of the pose for which lanes overlap, metres.
    #[arg(long, default_value_t = 0.01)]
    sigma_m: f64,
    /// The pattern by which the floor is swept.
    #[arg(long, value_enum, default_value_t)]
    pattern: PatternArgument,
    /// Print JSON, one object a home.
    #[arg(long)]
    json: bool,
}

/// A pattern by its name.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum PatternArgument {
    /// Straight lanes.
    #[default]
    Lines,
    /// Rings along walls and furniture.
    Contour,
}

impl From<PatternArgument> for Pattern {
    fn from(argument: PatternArgument) -> Self {
        match argument {
            PatternArgument::Lines => Self::Lines,
            PatternArgument::Contour => Self::Contour,
        }
    }
}

/// Figures of one plan. Times are multiples of T0; `null` = not reached.
#[derive(Debug, Serialize)]
struct PlanFigures {
    home: String,
    reachable_m2: f64,
    t0_s: f64,
    t80_over_t0: Option<f64>,
    t90_over_t0: Option<f64>,
    t95_over_t0: Option<f64>,
    share_at_1_8_t0: f64,
    covered: f64,
    end_over_t0: f64,
    turn_deg_per_m2: f64,
    lanes: usize,
    planning_s: f64,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let model = RobotModel::by_name(&arguments.robot)?;
    let progress = Progress::new("plans");
    for (number, path) in arguments.home.iter().enumerate() {
        let home = Home::load(path, &model)?;
        let figures = measured(&home, (&model, &arguments), |share| {
            progress.show((number as f64 + share) / arguments.home.len() as f64);
        });
        progress.clear();
        print(&figures, arguments.json)?;
    }
    Ok(())
}

fn measured(
    home: &Home,
    (model, arguments): (&RobotModel, &Arguments),
    progress: impl FnMut(f64),
) -> PlanFigures {
    let settings = PlanSettings {
        swath_m: model.body.swath_m,
        sigma_m: arguments.sigma_m,
        cruise_m_per_s: model.drive.cruise_m_per_s,
        turn_rad_per_s: model.drive.turn_max_rad_per_s,
        takes_along: true,
    };
    let ground = ground(home, model.body.radius_m);
    let pose = home.start();
    let start = Pose2 {
        x_m: pose.x_m,
        y_m: pose.y_m,
        heading_rad: pose.heading_rad,
    };
    let (plan, planning_s) = timed_plan(
        &ground,
        Departure { start, settings },
        arguments.pattern.into(),
        progress,
    );
    let curve = curve(home, &plan, &settings);
    let t0_s = home.t0_s();
    let reached = |share: f64| {
        curve
            .iter()
            .find(|(_, swept)| *swept >= share)
            .map(|(time_s, _)| time_s / t0_s)
    };
    let turn_rad: f64 = plan.segments.iter().map(|segment| segment.turn_rad.abs()).sum();
    PlanFigures {
        home: home.name().to_owned(),
        reachable_m2: home.reachable_area_m2(),
        t0_s,
        t80_over_t0: reached(0.8),
        t90_over_t0: reached(0.9),
        t95_over_t0: reached(0.95),
        share_at_1_8_t0: curve
            .iter()
            .take_while(|(time_s, _)| *time_s <= 1.8 * t0_s)
            .last()
            .map_or(0.0, |(_, swept)| *swept),
        covered: curve.last().map_or(0.0, |(_, swept)| *swept),
        end_over_t0: plan.time_s / t0_s,
        turn_deg_per_m2: turn_rad.to_degrees() / home.reachable_area_m2(),
        lanes: plan.lanes,
        planning_s,
    }
}

/// The plan, and the least time that it took in a few tries.
fn timed_plan(
    ground: &Raster<bool>,
    departure: Departure,
    pattern: Pattern,
    mut progress: impl FnMut(f64),
) -> (CoveragePlan, f64) {
    let mut best = (CoveragePlan::default(), f64::INFINITY);
    for number in 1..=TRIES {
        let (began, began_s) = (Instant::now(), processor_s());
        let plan = plan_pattern(ground, pattern, |_| false, departure);
        let planning_s = match (began_s, processor_s()) {
            (Some(began_s), Some(ended_s)) => ended_s - began_s,
            _ => began.elapsed().as_secs_f64(),
        };
        if planning_s < best.1 {
            best = (plan, planning_s);
        }
        progress(f64::from(number) / f64::from(TRIES));
    }
    best
}

/// Processor seconds of this thread, where the system reports them: others may use the machine, too.
fn processor_s() -> Option<f64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: u64 = text.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds as f64 * 1e-9)
}

/// Cells of the brain's size on which the middle of the body can be.
fn ground(home: &Home, radius_m: f64) -> Raster<bool> {
    let grid = home.grid();
    let cells = |count: usize| (count as f64 * grid.cell_m / CELL_M) as usize;
    let mut ground = Raster::filled(Cell { x: 0, y: 0 }, cells(grid.width), cells(grid.height), false);
    for index in 0..ground.values().len() {
        let at = ground.cell(index).middle();
        if let Some(free) = ground.values_mut().get_mut(index) {
            *free = home.clearance_m(at.x_m, at.y_m) >= radius_m;
        }
    }
    ground
}

/// Time in seconds and swept share of the reachable floor, place by place.
fn curve(home: &Home, plan: &CoveragePlan, settings: &PlanSettings) -> Vec<(f64, f64)> {
    let mut floor = SweptFloor {
        home,
        swept: vec![false; home.grid().cells.len()],
        count: 0,
        radius_m: 0.5 * settings.swath_m,
    };
    let all = home.reachable().iter().filter(|cell| **cell).count().max(1) as f64;
    let mut time_s = 0.0;
    let mut curve = Vec::new();
    for segment in &plan.segments {
        let steps = (segment.length_m / STEP_M).ceil().max(1.0) as u32;
        for step in 1..=steps {
            let share = f64::from(step) / f64::from(steps);
            floor.sweep(segment.at(share));
            curve.push((
                time_s + share * settings.time_s(segment),
                floor.count as f64 / all,
            ));
        }
        time_s += settings.time_s(segment);
    }
    curve
}

/// What was swept.
struct SweptFloor<'home> {
    home: &'home Home,
    swept: Vec<bool>,
    count: usize,
    radius_m: f64,
}

impl SweptFloor<'_> {
    fn sweep(&mut self, pose: Pose2) {
        let grid = self.home.grid();
        let span = |middle_m: f64, count: usize| {
            let first = ((middle_m - self.radius_m) / grid.cell_m).max(0.0) as usize;
            first..(((middle_m + self.radius_m) / grid.cell_m) as usize + 1).min(count)
        };
        for row in span(pose.y_m, grid.height) {
            for column in span(pose.x_m, grid.width) {
                let index = row * grid.width + column;
                let (x_m, y_m) = grid.centre(index);
                let away_m = (x_m - pose.x_m).hypot(y_m - pose.y_m);
                if away_m <= self.radius_m && self.home.reachable()[index] && !self.swept[index] {
                    self.swept[index] = true;
                    self.count += 1;
                }
            }
        }
    }
}

fn print(figures: &PlanFigures, json: bool) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    if json {
        serde_json::to_writer(&mut out, figures)?;
        writeln!(out)?;
        return Ok(());
    }
    let times = [figures.t80_over_t0, figures.t90_over_t0, figures.t95_over_t0]
        .map(|time| time.map_or_else(|| "-".to_owned(), |time| format!("{time:.2}")));
    writeln!(
        out,
        "{}: {:.1} m2, T0 {:.1} min; t80 {} t90 {} t95 {} T0; {:.3} at 1.8 T0, {:.3} at the end ({:.2} T0); turns {:.0} deg/m2; {} lanes, planned in {:.0} ms",
        figures.home,
        figures.reachable_m2,
        figures.t0_s / 60.0,
        times[0],
        times[1],
        times[2],
        figures.share_at_1_8_t0,
        figures.covered,
        figures.end_over_t0,
        figures.turn_deg_per_m2,
        figures.lanes,
        1000.0 * figures.planning_s
    )?;
    Ok(())
}
