//! `cargo xtask test`: every check and test of the project in one command, stage after stage.

mod count;
mod robot;
mod runner;
mod stages;
mod verdicts;

use crate::panel::Ahead;
use crate::process;
use anyhow::bail;
use count::Count;
use stages::{STAGES, Stage};
use std::time::{Duration, Instant};

/// Arguments of `cargo xtask test`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Stages to run; all when none is named.
    stages: Vec<String>,
    /// Run only this stage; may be given several times.
    #[arg(long, value_name = "STAGE")]
    only: Vec<String>,
    /// Print what the stage `attacks` saw as JSON, and nothing else.
    #[arg(long)]
    json: bool,
    /// Print the names of the stages and what each does.
    #[arg(long)]
    list: bool,
    /// Many more seeds and corrupted packets.
    #[arg(long)]
    long: bool,
}

/// How a stage ended.
struct Outcome {
    stage: &'static Stage,
    count: Count,
    errors: Vec<anyhow::Error>,
    took: Duration,
}

/// Runs the stages; fails when one fails. The last line is `N passed, N failed`.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    if arguments.list {
        STAGES
            .iter()
            .for_each(|stage| process::print(&format!("{:10} {}", stage.name, stage.does)));
        return Ok(());
    }
    let names: Vec<String> = arguments.stages.iter().chain(&arguments.only).cloned().collect();
    if arguments.json {
        if names != ["attacks"] {
            bail!("--json is for one stage: cargo xtask test attacks --json");
        }
        return stages::attacks_as_json();
    }
    let outcomes = run_all(&chosen(&names)?, arguments.long);
    let mut total = Count::default();
    process::print("");
    for outcome in &outcomes {
        total.add(outcome.count);
        process::print(&row(outcome));
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

fn chosen(names: &[String]) -> anyhow::Result<Vec<&'static Stage>> {
    if names.is_empty() {
        return Ok(STAGES.iter().collect());
    }
    let find = |name: &String| match STAGES.iter().find(|stage| stage.name == name) {
        Some(stage) => Ok(stage),
        None => bail!("there is no stage {name:?}; cargo xtask test --list names them"),
    };
    names.iter().map(find).collect()
}

/// Runs stage after stage. The panel that the browser needs is built beside the stages that measure no time.
fn run_all(stages: &[&'static Stage], long: bool) -> Vec<Outcome> {
    let browser_follows = stages.iter().any(|stage| stage.name == "browser");
    let mut ahead = None;
    let mut outcomes = Vec::new();
    for stage in stages {
        if stage.name == "panel" && browser_follows {
            ahead = told(Ahead::begin());
        }
        if stage.wants_the_machine
            && let Some(panel) = ahead.take()
        {
            told(panel.finish());
        }
        outcomes.push(run_one(stage, long));
    }
    outcomes
}

/// What went right. What did not is said, and the stage that needs it fails by itself.
fn told<T>(result: anyhow::Result<T>) -> Option<T> {
    result
        .map_err(|error| process::complain(&format!("the panel is not built meanwhile: {error:#}")))
        .ok()
}

fn run_one(stage: &'static Stage, long: bool) -> Outcome {
    process::say(&format!("stage {}: {}", stage.name, stage.does));
    let begun = Instant::now();
    let (count, errors) = match (stage.run)(long) {
        Ok(count) => (count, Vec::new()),
        Err(runner::Failed { count, errors }) => (count.with_a_failure(), errors),
    };
    complain_of(stage, &errors);
    Outcome {
        stage,
        count,
        errors,
        took: begun.elapsed(),
    }
}

fn complain_of(stage: &Stage, errors: &[anyhow::Error]) {
    for error in errors {
        process::complain(&format!("stage {}: {error:#}", stage.name));
    }
}

fn row(outcome: &Outcome) -> String {
    let verdict = if outcome.errors.is_empty() { "ok" } else { "FAILED" };
    format!(
        "{:10} {verdict:6} {:7.1} s  {}",
        outcome.stage.name,
        outcome.took.as_secs_f64(),
        outcome.count
    )
}
