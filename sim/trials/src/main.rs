//! `bench-safety`: every safety rule on the real firmware in the emulated chip, at many phases, with its worst reaction
//! beside its limit. `cargo xtask bench safety` builds and runs it.
#![forbid(unsafe_code)]

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use serde::Serialize;
use trials::measured::Measured;
use trials::{Campaign, CampaignError, Fixture, Trial, TrialSummary, conclude, trials};

/// Tries every safety rule on a firmware.
#[derive(Debug, Parser)]
#[command(args_override_self = true)]
struct Arguments {
    /// The firmware, as ELF.
    #[arg(long)]
    firmware: PathBuf,
    /// Moments at which each fault happens.
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    phases: u32,
    /// Seed of the moments.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only this rule, for example S6, or this trial; may be given several times.
    #[arg(long)]
    rule: Vec<String>,
    /// Robots without noise and with a perfect calibration.
    #[arg(long)]
    ideal: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// The figures of the last long run: fail when one got worse.
    #[arg(long)]
    check: Option<PathBuf>,
    /// Write the figures there.
    #[arg(long, conflicts_with = "check")]
    write: Option<PathBuf>,
    /// A file with what cordlib's tests printed, to be compared or written like the figures.
    #[arg(long)]
    tests: Option<PathBuf>,
}

#[derive(Debug, Serialize)]
struct SafetyReport {
    phases: u32,
    broken: usize,
    violations: usize,
    worse: Vec<String>,
    trials: Vec<TrialSummary>,
}

fn main() -> ExitCode {
    conclude("bench-safety", run(&Arguments::parse()), "a rule was broken")
}

fn run(arguments: &Arguments) -> Result<bool, CampaignError> {
    let wanted = |trial: &Trial| {
        arguments.rule.is_empty()
            || arguments
                .rule
                .iter()
                .any(|rule| rule.eq_ignore_ascii_case(trial.rule()) || rule == trial.name)
    };
    let chosen: Vec<Trial> = trials().into_iter().filter(wanted).collect();
    let mut fixture = Fixture::open(&arguments.firmware)?;
    if !arguments.ideal {
        fixture = fixture.with_drawn_robots();
    }
    let campaign = Campaign::open(&fixture, &chosen, arguments.phases as usize)?;
    let mut out = io::stdout().lock();
    if !arguments.json {
        writeln!(
            out,
            "{:<6} {:<28} {:>9} {:>9} {:>7}  fault",
            "rule", "trial", "worst ms", "mean ms", "limit"
        )?;
    }
    let mut report = SafetyReport {
        phases: arguments.phases,
        broken: 0,
        violations: 0,
        worse: Vec::new(),
        trials: Vec::new(),
    };
    for trial in &chosen {
        let summary = campaign.judge(trial, arguments.phases as usize, arguments.seed);
        if !arguments.json {
            summary.print(&mut out)?;
        }
        report.broken += summary.broken;
        report.violations += summary.violations;
        keep(arguments, &summary, &mut report.worse)?;
        report.trials.push(summary);
    }
    if let Some(printed) = &arguments.tests {
        report.worse.extend(take_over(printed, arguments)?);
    }
    if arguments.json {
        serde_json::to_writer(&mut out, &report).map_err(io::Error::from)?;
        writeln!(out)?;
    }
    for complaint in &report.worse {
        writeln!(io::stderr(), "bench-safety: {complaint}")?;
    }
    let kept = !report.trials.is_empty() && report.trials.iter().all(TrialSummary::is_kept);
    Ok(kept && report.worse.is_empty())
}

/// Compares with the figures of the last long run, or writes them: after each trial, so that a run that is interrupted was
/// not in vain.
fn keep(arguments: &Arguments, summary: &TrialSummary, worse: &mut Vec<String>) -> Result<(), CampaignError> {
    if let Some(path) = &arguments.check {
        worse.extend(Measured::read(path)?.complaint(summary));
    }
    if let Some(path) = &arguments.write {
        let mut known = Measured::read(path)?;
        known.renew(summary);
        known.write(path)?;
    }
    Ok(())
}

/// Compares what cordlib's tests printed, or writes it; returns what got worse.
fn take_over(printed: &Path, arguments: &Arguments) -> Result<Vec<String>, CampaignError> {
    let figures = printed_by_tests(&std::fs::read_to_string(printed)?);
    if let Some(path) = &arguments.write {
        let mut known = Measured::read(path)?;
        known.tests = figures;
        known.write(path)?;
        return Ok(Vec::new());
    }
    let Some(path) = &arguments.check else {
        return Ok(Vec::new());
    };
    let known = Measured::read(path)?;
    let complaints = figures
        .iter()
        .filter_map(|(name, ms)| known.complaint_of_tests(name, *ms));
    Ok(complaints.collect())
}

/// The worst of each figure in lines like `worst S6.stop 1 ms, limit 20 ms`.
fn printed_by_tests(text: &str) -> BTreeMap<String, f64> {
    let mut worst: BTreeMap<String, f64> = BTreeMap::new();
    let figures = text.lines().filter_map(|line| {
        let mut words = line.split_once("worst ")?.1.split(' ');
        Some((words.next()?, words.next()?.parse::<f64>().ok()?))
    });
    for (name, ms) in figures {
        let place = worst.entry(name.to_owned()).or_default();
        *place = place.max(ms);
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::printed_by_tests;

    #[test]
    fn the_worst_of_each_figure_is_read() {
        let text =
            "running\nworst S6.stop 1 ms, limit 20 ms\ntest a ... worst S9.blind 900 ms\nworst S6.stop 2 ms";
        let worst = printed_by_tests(text);
        assert_eq!(worst.len(), 2);
        assert_eq!([worst["S6.stop"], worst["S9.blind"]], [2.0, 900.0]);
    }
}
