//! `bench-relax`: the safety rules that the Relax can have, on its image in the emulated chip, with the worst reaction beside the
//! limit. `cargo xtask bench relax` builds and runs it.
#![forbid(unsafe_code)]

use clap::Parser;
use serde::Serialize;
use stc90::hosted::HostedBlueprint;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use trials::relax::{RelaxCampaign, RelaxTrial, flipped_flash, trials};
use trials::{CampaignError, TrialSummary, conclude};

/// Tries the Relax's safety rules.
#[derive(Debug, Parser)]
#[command(args_override_self = true)]
struct Arguments {
    /// The firmware, as Intel HEX.
    #[arg(long)]
    firmware: PathBuf,
    /// Moments at which each fault happens.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    phases: u32,
    /// Seed of the moments.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only this rule, for example S6, or this trial; may be given several times.
    #[arg(long)]
    rule: Vec<String>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Serialize)]
struct RelaxReport {
    phases: u32,
    broken: usize,
    violations: usize,
    trials: Vec<TrialSummary>,
}

fn main() -> ExitCode {
    conclude("bench-relax", run(&Arguments::parse()), "a rule was broken")
}

fn run(arguments: &Arguments) -> Result<bool, CampaignError> {
    let text = std::fs::read_to_string(&arguments.firmware)?;
    let campaign = RelaxCampaign::open(&HostedBlueprint::from_hex(&text)?)?;
    let is_wanted = |rule: &str, name: &str| {
        let mut asked = arguments.rule.iter();
        arguments.rule.is_empty() || asked.any(|asked| asked.eq_ignore_ascii_case(rule) || asked == name)
    };
    let chosen: Vec<RelaxTrial> = trials()
        .into_iter()
        .filter(|trial| is_wanted(trial.rule(), trial.name))
        .collect();
    let mut out = io::stdout().lock();
    let mut report = RelaxReport {
        phases: arguments.phases,
        broken: 0,
        violations: 0,
        trials: Vec::new(),
    };
    let judged = chosen
        .iter()
        .map(|trial| Ok(campaign.judge(trial, arguments.phases as usize, arguments.seed)));
    let flash = is_wanted("S21", "image-bit-flips").then(|| flipped_flash(&text));
    for summary in judged.chain(flash) {
        let summary = summary?;
        if !arguments.json {
            summary.print(&mut out)?;
        }
        report.broken += summary.broken;
        report.violations += summary.violations;
        report.trials.push(summary);
    }
    if arguments.json {
        serde_json::to_writer(&mut out, &report).map_err(io::Error::from)?;
        writeln!(out)?;
    }
    Ok(!report.trials.is_empty() && report.trials.iter().all(TrialSummary::is_kept))
}
