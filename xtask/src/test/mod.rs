//! `cargo xtask test`: the checks and tests of the project in one command, stage after stage; with `--all` every one of them.

mod browser;
mod campaigns;
mod code;
mod count;
mod extent;
mod flash;
mod home_assistant;
mod joined;
mod packages;
mod programs;
mod robot;
mod runner;
mod stages;
mod verdicts;

use crate::panel::{Ahead, Page};
use crate::{process, processor};
use anyhow::bail;
use count::Count;
use extent::Extent;
use stages::{Company, STAGES, Stage};
use std::time::{Duration, Instant};

/// Arguments of `cargo xtask test`.
#[derive(Debug, clap::Args)]
pub(crate) struct TestArguments {
    /// Stages to run; when none is named, all that belong to what is asked for.
    stages: Vec<String>,
    /// Run only this stage; may be given several times.
    #[arg(long, value_name = "STAGE")]
    only: Vec<String>,
    /// Print what the stage `attacks`, `flash`, `joined` or `packages` saw as JSON, and nothing else.
    #[arg(long)]
    json: bool,
    /// Print the names of the stages, which of them run without --all, and what each does.
    #[arg(long)]
    list: bool,
    /// Everything, as on the build machine: the campaigns of each stage, the emulated chip, the browser.
    #[arg(long)]
    all: bool,
    /// As --all, with many more seeds and corrupted packets.
    #[arg(long)]
    long: bool,
}

impl TestArguments {
    fn extent(&self) -> Extent {
        match self {
            Self { long: true, .. } => Extent::Long,
            Self { all: true, .. } => Extent::All,
            _ => Extent::Short,
        }
    }
}

/// How a stage ended.
struct Outcome {
    stage: &'static Stage,
    count: Count,
    errors: Vec<anyhow::Error>,
    took: Duration,
    processor: Duration,
}

/// Runs the stages; fails when one fails. The last line is `N passed, N failed`.
pub(crate) fn run(arguments: &TestArguments) -> anyhow::Result<()> {
    if arguments.list {
        list();
        return Ok(());
    }
    let names: Vec<String> = arguments.stages.iter().chain(&arguments.only).cloned().collect();
    if arguments.json {
        return match names.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
            ["attacks"] => programs::attacks_as_json(),
            ["flash"] => flash::as_json(arguments.extent().max(Extent::All)),
            ["joined"] => joined::as_json(),
            ["packages"] => packages::as_json(arguments.extent()),
            _ => {
                bail!("--json is for one stage: cargo xtask test attacks --json, or flash, joined, packages")
            }
        };
    }
    let extent = arguments.extent();
    let outcomes = run_all(&chosen(&names, extent)?, extent);
    let mut total = Count::default();
    process::print("");
    for outcome in &outcomes {
        total.add(outcome.count);
        process::print(&row(outcome));
    }
    if outcomes.len() > 1 {
        process::print(&together(&outcomes));
    }
    process::print(&total.to_string());
    if outcomes.len() > 1 {
        // Said once more: in the middle of a long run nobody sees it.
        outcomes
            .iter()
            .for_each(|outcome| complain_of(outcome.stage, &outcome.errors));
    }
    if total.failed > 0 {
        bail!("{} failed", total.failed);
    }
    Ok(())
}

fn list() {
    for stage in &STAGES {
        process::print(&format!("{:10} {:6} {}", stage.name, stage.from, stage.does));
    }
    process::print("cargo xtask test runs what is short; with --all it runs everything, and more of each");
}

/// The stages of these names, or those that belong to the extent.
fn chosen(names: &[String], extent: Extent) -> anyhow::Result<Vec<&'static Stage>> {
    if names.is_empty() {
        return Ok(STAGES.iter().filter(|stage| stage.from <= extent).collect());
    }
    let find = |name: &String| match STAGES.iter().find(|stage| stage.name == name) {
        Some(stage) => Ok(stage),
        None => bail!("there is no stage {name:?}; cargo xtask test --list names them"),
    };
    names.iter().map(find).collect()
}

/// Runs stage after stage, a few of them side by side. The panel that the browser needs is built beside the stages that measure no time.
fn run_all(stages: &[&'static Stage], extent: Extent) -> Vec<Outcome> {
    let browser_follows = stages.iter().any(|stage| stage.name == "browser");
    let mut ahead = None;
    let mut outcomes = Vec::new();
    let mut left = stages;
    while let [stage, after @ ..] = left {
        if stage.name == "tests" && browser_follows {
            ahead = told(Ahead::begin(Page::Release));
        }
        if stage.company != Company::Anything
            && let Some(panel) = ahead.take()
        {
            told(panel.finish());
        }
        left = match after {
            [next, rest @ ..] if stage.company == Company::TheNext => {
                outcomes.extend(run_both([*stage, *next], extent));
                rest
            }
            _ => {
                outcomes.push(run_one(stage, extent));
                after
            }
        };
    }
    outcomes
}

/// Runs two stages side by side. The processor does not tell for which of them it worked: the first one gets it all.
fn run_both([one, other]: [&'static Stage; 2], extent: Extent) -> [Outcome; 2] {
    std::thread::scope(|scope| {
        let beside = scope.spawn(|| run_one(other, extent));
        let first = run_one(one, extent);
        let mut second = beside
            .join()
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        second.processor = Duration::ZERO;
        [first, second]
    })
}

/// What went right. What did not is said, and the stage that needs it fails by itself.
fn told<T>(result: anyhow::Result<T>) -> Option<T> {
    result
        .map_err(|error| process::complain(&format!("the panel is not built meanwhile: {error:#}")))
        .ok()
}

/// Runs a stage. One of the campaigns that is named alone runs as it does among all.
fn run_one(stage: &'static Stage, extent: Extent) -> Outcome {
    process::say(&format!("stage {}: {}", stage.name, stage.does));
    let begun = Instant::now();
    let before = processor::of_ended_children();
    let (count, errors) = match (stage.run)(extent.max(stage.from)) {
        Ok(count) => (count, Vec::new()),
        Err(runner::Failed { count, errors }) => (count.with_a_failure(), errors),
    };
    complain_of(stage, &errors);
    let outcome = Outcome {
        stage,
        count,
        errors,
        took: begun.elapsed(),
        processor: processor::of_ended_children().saturating_sub(before),
    };
    process::say(&row(&outcome));
    outcome
}

fn complain_of(stage: &Stage, errors: &[anyhow::Error]) {
    for error in errors {
        process::complain(&format!("stage {}: {error:#}", stage.name));
    }
}

fn row(outcome: &Outcome) -> String {
    let verdict = if outcome.errors.is_empty() { "ok" } else { "FAILED" };
    format!(
        "{:10} {verdict:6} {}  {}",
        outcome.stage.name,
        times(outcome.took, outcome.processor),
        outcome.count
    )
}

/// The seconds of all stages.
fn together(outcomes: &[Outcome]) -> String {
    let took = outcomes.iter().map(|outcome| outcome.took).sum();
    let processor = outcomes.iter().map(|outcome| outcome.processor).sum();
    format!("{:10} {:6} {}", "together", "", times(took, processor))
}

fn times(took: Duration, processor: Duration) -> String {
    let (took, processor) = (took.as_secs_f64(), processor.as_secs_f64());
    format!("{took:7.1} s, {processor:7.1} s of processor")
}
