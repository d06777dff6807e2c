//! Tries the bridges against real software of others: a simulated robot, the real daemon, the real bridge, and the real peer.
#![forbid(unsafe_code)]

mod broker;
mod home;
mod home_assistant;
mod http;
mod load;
mod mosquitto;
mod notifications;
mod process;
mod program;
mod prometheus;
mod verdict;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use clap::Parser;
use verdict::Verdict;

#[derive(Debug, Parser)]
#[command(about = "Tries the bridges against real software of others")]
struct Arguments {
    /// Prints one JSON object
    #[arg(long)]
    json: bool,
    /// More breaks of each connection
    #[arg(long)]
    long: bool,
    /// Only this peer; may be given several times
    #[arg(long, value_name = "PEER")]
    only: Vec<String>,
    /// A Python that has the package icalendar
    #[arg(long, value_name = "FILE")]
    python: Option<PathBuf>,
    /// The program of Home Assistant, which is tried when it is named
    #[arg(long, value_name = "FILE")]
    hass: Option<PathBuf>,
}

/// A peer, and how it is tried.
type Trial = (&'static str, fn(&Arguments, &mut Verdict) -> anyhow::Result<()>);

const TRIALS: [Trial; 5] = [
    ("mosquitto", mosquitto::trial),
    ("load", load::trial),
    ("prometheus", prometheus::trial),
    ("python", notifications::trial),
    ("home-assistant", home_assistant::trial),
];

fn main() -> ExitCode {
    match try_all(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("try-joined: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn try_all(arguments: &Arguments) -> anyhow::Result<()> {
    if let Some(unknown) = arguments
        .only
        .iter()
        .find(|name| !TRIALS.iter().any(|(known, _)| known == name))
    {
        bail!("there is no peer {unknown:?}");
    }
    let mut verdicts = Vec::new();
    for (name, trial) in TRIALS {
        let wanted = if arguments.only.is_empty() {
            name != "home-assistant" || arguments.hass.is_some()
        } else {
            arguments.only.iter().any(|only| only == name)
        };
        if wanted {
            let mut verdict = Verdict::of(name);
            if let Err(error) = trial(arguments, &mut verdict) {
                verdict.ended_early(&error);
            }
            eprintln!("{verdict}");
            verdicts.push(verdict);
        }
    }
    if arguments.json {
        println!("{}", serde_json::json!({"peers": verdicts}));
    }
    let failed: usize = verdicts.iter().map(Verdict::failures).sum();
    if failed > 0 {
        bail!("{failed} checks failed");
    }
    Ok(())
}
