//! `bench-coverage`: the robot with the firmware that is built in and the one with its real image in the emulated chip clean
//! the same home with the same seeds and strategy. `cargo xtask bench coverage` builds and runs it.
//!
//! A robot that bounces is chaotic: a millisecond more at the first wall gives another path through the whole home. One run says
//! nothing, so each seed is run with both, and the output is the mean of the differences and its uncertainty.
#![forbid(unsafe_code)]

#[path = "../progress.rs"]
mod progress;

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::Context;
use brain::command::StrategyName;
use clap::Parser;
use home::{Home, RobotModel};
use pic32::board::CalibrationChoice;
use progress::Progress;
use rvac_sim::run::{RunSettings, household, run};
use rvac_sim::{FieldMeasures, Firmware, RunReport, Scene, field_line};
use serde::Serialize;

/// Compares how well two firmwares clean.
#[derive(Debug, Parser)]
struct Arguments {
    /// Home: a ROS map .yaml, a Valetudo map .json, or a home .toml; may be given several times.
    #[arg(long, default_value = "homes/two-room-flat.toml")]
    home: Vec<PathBuf>,
    /// The image of the real firmware, as ELF or HEX.
    #[arg(long)]
    firmware: PathBuf,
    /// Cleaning strategy by name.
    #[arg(long, default_value = "bounce")]
    strategy: String,
    /// The robot has a perfect map of the home, which `systematic` needs.
    #[arg(long)]
    known_map: bool,
    /// Noise class: ideal, good, nominal or bad; parts of it can differ, as in `nominal,gyro=0,wheel-scale=2`.
    #[arg(long, default_value = "nominal")]
    noise: String,
    /// How many seeds, from 1 on.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u64).range(2..=1_000))]
    seeds: u64,
    /// Simulated minutes of each run.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=600))]
    minutes: u64,
    /// How far the covered shares may be apart, as a part of the share.
    #[arg(long, default_value_t = 0.05)]
    tolerance: f64,
    /// Print JSON, one object a home.
    #[arg(long)]
    json: bool,
}

/// Both robots with one seed.
#[derive(Debug, Serialize)]
struct Pair {
    seed: u64,
    built_in: RunReport,
    emulated: RunReport,
}

/// One figure of all pairs.
#[derive(Debug, Serialize)]
struct PairFigure {
    built_in_mean: f64,
    emulated_mean: f64,
    /// Emulated less built in, as a part of the built-in mean.
    difference: f64,
    /// Half of the interval in which the true difference lies with 95 %, in the same unit.
    uncertainty: f64,
}

/// What the pairs say about the tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum ToleranceVerdict {
    /// The whole interval is within it.
    Within,
    /// The difference that was seen is within it, but there were too few runs to be sure.
    WithinByWhatWasSeen,
    /// The difference that was seen is beyond it, and chance alone can be the cause.
    Open,
    /// The whole interval is beyond it.
    Beyond,
}

#[derive(Debug, Serialize)]
struct Comparison {
    home: String,
    minutes: u64,
    covered: PairFigure,
    path_m: PairFigure,
    bumps: PairFigure,
    violations: u32,
    verdict: ToleranceVerdict,
    pairs: Vec<Pair>,
}

/// The robot whose firmware and twin are compared.
const ROBOT: &str = "sr8730";

/// Student's distribution: within so many standard errors the true mean lies with 95 %, for 1, 2, ... degrees of freedom.
const STUDENT: [f64; 15] = [
    12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23, 2.20, 2.18, 2.16, 2.14, 2.13,
];
/// The same for more of them: on the safe side.
const STUDENT_MANY: f64 = 2.12;

fn main() -> anyhow::Result<ExitCode> {
    let arguments = Arguments::parse();
    let firmware = Firmware::load(ROBOT, Some(&arguments.firmware), &CalibrationChoice::Complete)?;
    let mut is_close = true;
    for path in &arguments.home {
        let comparison = compare(&arguments, &firmware, path)?;
        is_close &= comparison.verdict != ToleranceVerdict::Beyond && comparison.violations == 0;
        print(&comparison, arguments.json)?;
    }
    Ok(if is_close {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

fn compare(arguments: &Arguments, firmware: &Firmware, path: &Path) -> anyhow::Result<Comparison> {
    let strategy = StrategyName::from_name(&arguments.strategy)
        .with_context(|| format!("no strategy is called {}", arguments.strategy))?;
    let noise = arguments.noise.parse()?;
    let model = RobotModel::by_name(ROBOT)?;
    let home = Arc::new(Home::load(path, &model)?);
    let built_in = Scene::new(home, model, noise);
    let emulated = built_in.clone().with_firmware(firmware.clone());
    let progress = Progress::new("coverage");
    let clean = |scene: &Scene, (seed, before): (u64, f64)| {
        let settings = RunSettings {
            strategy,
            pattern: None,
            seed,
            duration_ms: arguments.minutes * 60_000,
        };
        let household = household(scene, &settings);
        let mut household = if arguments.known_map {
            household.with_known_map()
        } else {
            household
        };
        run(&mut household, &settings, |share| {
            let runs = (seed - 1) as f64 * 2.0 + before + share;
            progress.show(runs / (2 * arguments.seeds) as f64);
        })
    };
    let mut pairs = Vec::new();
    for seed in 1..=arguments.seeds {
        let pair = Pair {
            seed,
            built_in: clean(&built_in, (seed, 0.0))?,
            emulated: clean(&emulated, (seed, 1.0))?,
        };
        progress.clear();
        tell(&pair);
        pairs.push(pair);
    }
    let violations = pairs
        .iter()
        .map(|pair| pair.built_in.monitor_violations + pair.emulated.monitor_violations);
    let covered = figure(&pairs, |report| report.covered);
    Ok(Comparison {
        home: built_in.home().name().to_owned(),
        minutes: arguments.minutes,
        path_m: figure(&pairs, |report| report.path_m),
        bumps: figure(&pairs, |report| f64::from(report.bumps)),
        violations: violations.sum(),
        verdict: verdict(&covered, arguments.tolerance),
        covered,
        pairs,
    })
}

fn figure(pairs: &[Pair], of: fn(&RunReport) -> f64) -> PairFigure {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let built_in: Vec<f64> = pairs.iter().map(|pair| of(&pair.built_in)).collect();
    let emulated: Vec<f64> = pairs.iter().map(|pair| of(&pair.emulated)).collect();
    let differences: Vec<f64> = emulated.iter().zip(&built_in).map(|(e, b)| e - b).collect();
    let (built_in_mean, difference) = (mean(&built_in), mean(&differences));
    let freedom = differences.len() - 1;
    let squares = differences.iter().map(|value| (value - difference).powi(2));
    let deviation = (squares.sum::<f64>() / freedom as f64).sqrt();
    let student = STUDENT.get(freedom - 1).unwrap_or(&STUDENT_MANY);
    PairFigure {
        built_in_mean,
        emulated_mean: mean(&emulated),
        difference: difference / built_in_mean,
        uncertainty: student * deviation / (differences.len() as f64).sqrt() / built_in_mean,
    }
}

fn verdict(covered: &PairFigure, tolerance: f64) -> ToleranceVerdict {
    let (seen, uncertainty) = (covered.difference.abs(), covered.uncertainty);
    if seen + uncertainty <= tolerance {
        ToleranceVerdict::Within
    } else if seen <= tolerance {
        ToleranceVerdict::WithinByWhatWasSeen
    } else if seen - uncertainty <= tolerance {
        ToleranceVerdict::Open
    } else {
        ToleranceVerdict::Beyond
    }
}

/// A run takes minutes, so show progress.
fn tell(pair: &Pair) {
    let one = |report: &RunReport| {
        format!(
            "{:5.1} % covered, {:5.1} m, {:4} bumps",
            report.covered * 100.0,
            report.path_m,
            report.bumps
        )
    };
    writeln!(
        io::stderr(),
        "seed {:<4} built in {}; emulated {}",
        pair.seed,
        one(&pair.built_in),
        one(&pair.emulated)
    )
    .ok();
}

fn print(comparison: &Comparison, json: bool) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    if json {
        serde_json::to_writer(&mut out, comparison)?;
        writeln!(out)?;
        return Ok(());
    }
    writeln!(
        out,
        "{}, {} minutes, {} seeds: means, built in and emulated",
        comparison.home,
        comparison.minutes,
        comparison.pairs.len()
    )?;
    for (name, figure, factor) in [
        ("covered, %", &comparison.covered, 100.0),
        ("way, m", &comparison.path_m, 1.0),
        ("bumps", &comparison.bumps, 1.0),
    ] {
        writeln!(
            out,
            "{name:<12} {:7.1} {:7.1}   difference {:+.1} % +- {:.1} %",
            figure.built_in_mean * factor,
            figure.emulated_mean * factor,
            figure.difference * 100.0,
            figure.uncertainty * 100.0
        )?;
    }
    for (name, of) in [
        ("built in", (|pair| &pair.built_in) as fn(&Pair) -> &RunReport),
        ("emulated", |pair| &pair.emulated),
    ] {
        let jobs: Vec<FieldMeasures> = comparison
            .pairs
            .iter()
            .filter_map(|pair| of(pair).figures.as_ref())
            .map(|figures| figures.field)
            .collect();
        writeln!(out, "{name:<12} {}", field_line(FieldMeasures::means(&jobs)))?;
    }
    let words = match comparison.verdict {
        ToleranceVerdict::Within => "within the tolerance",
        ToleranceVerdict::WithinByWhatWasSeen => {
            "within the tolerance by what was seen; more seeds would make it sure"
        }
        ToleranceVerdict::Open => "beyond the tolerance, but chance alone can be the cause: take more seeds",
        ToleranceVerdict::Beyond => "beyond the tolerance",
    };
    writeln!(out, "{words}; {} breaches", comparison.violations)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{PairFigure, ToleranceVerdict, verdict};

    #[test]
    fn what_is_seen_and_how_sure_it_is_decide_together() {
        for (difference, uncertainty, wanted) in [
            (0.01, 0.02, ToleranceVerdict::Within),
            (-0.04, 0.02, ToleranceVerdict::WithinByWhatWasSeen),
            (-0.06, 0.02, ToleranceVerdict::Open),
            (0.08, 0.02, ToleranceVerdict::Beyond),
        ] {
            let covered = PairFigure {
                built_in_mean: 0.5,
                emulated_mean: 0.5,
                difference,
                uncertainty,
            };
            assert_eq!(verdict(&covered, 0.05), wanted, "{difference}");
        }
    }
}
