//! `bench-safety`: every safety rule on the real firmware in the emulated chip, at many phases, with its worst reaction
//! beside its limit. `cargo xtask bench safety` builds and runs it.
#![forbid(unsafe_code)]

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use serde::Serialize;
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
    /// Only this rule, for example S6; may be given several times.
    #[arg(long)]
    rule: Vec<String>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Serialize)]
struct SafetyReport {
    phases: u32,
    broken: usize,
    violations: usize,
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
                .any(|rule| rule.eq_ignore_ascii_case(trial.rule))
    };
    let chosen: Vec<Trial> = trials().into_iter().filter(wanted).collect();
    let fixture = Fixture::open(&arguments.firmware)?;
    let campaign = Campaign::open(&fixture, &chosen, arguments.phases as usize)?;
    let mut out = io::stdout().lock();
    if !arguments.json {
        writeln!(
            out,
            "{:<4} {:<52} {:>9} {:>9} {:>7}",
            "rule", "fault", "worst ms", "mean ms", "limit"
        )?;
    }
    let mut report = SafetyReport {
        phases: arguments.phases,
        broken: 0,
        violations: 0,
        trials: Vec::new(),
    };
    for trial in &chosen {
        let verdict = campaign.judge(trial, arguments.phases as usize, arguments.seed);
        if !arguments.json {
            print(&mut out, &verdict)?;
        }
        report.broken += verdict.broken;
        report.violations += verdict.violations;
        report.trials.push(verdict);
    }
    if arguments.json {
        serde_json::to_writer(&mut out, &report).map_err(io::Error::from)?;
        writeln!(out)?;
    }
    Ok(!report.trials.is_empty() && report.trials.iter().all(TrialSummary::is_kept))
}

fn print(out: &mut impl Write, verdict: &TrialSummary) -> io::Result<()> {
    let worst = verdict
        .worst_ms
        .map_or_else(|| "never".to_owned(), |worst_ms| format!("{worst_ms:.2}"));
    let remark = if verdict.is_kept() {
        String::new()
    } else {
        format!(
            "  BROKEN {} of {} times, {} breaches; said: {}",
            verdict.broken,
            verdict.phases,
            verdict.violations,
            verdict.said.join(", ")
        )
    };
    writeln!(
        out,
        "{:<4} {:<52} {worst:>9} {:>9.2} {:>7}{remark}",
        verdict.rule, verdict.what, verdict.mean_ms, verdict.limit_ms
    )?;
    out.flush()
}
