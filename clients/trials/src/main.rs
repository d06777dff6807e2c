//! Tries the bridges against real software of others: a simulated robot, the real daemon, the real bridge, and the real peer.
#![forbid(unsafe_code)]

mod broker;
mod dialect;
mod foxglove;
mod home;
mod home_assistant;
mod http;
mod load;
mod matter;
mod mosquitto;
mod notifications;
mod process;
mod program;
mod prometheus;
mod ros2;
mod schemathesis;
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
    /// A Python that has the package valetudo-map-parser; the map is drawn by it when it is named
    #[arg(long, value_name = "FILE")]
    map_python: Option<PathBuf>,
    /// The program of Home Assistant, which is tried when it is named
    #[arg(long, value_name = "FILE")]
    hass: Option<PathBuf>,
    /// The program schemathesis, which is tried when it is named
    #[arg(long, value_name = "FILE")]
    schemathesis: Option<PathBuf>,
    /// The bridge to ROS 2, which is a workspace of its own; tried when it is named
    #[arg(long, value_name = "FILE", requires = "ros2_python")]
    ros2: Option<PathBuf>,
    /// The server for Foxglove, which is a workspace of its own; tried when it is named
    #[arg(long, value_name = "FILE", requires = "foxglove_python")]
    foxglove: Option<PathBuf>,
    /// A Python that has the packages websockets and protobuf
    #[arg(long, value_name = "FILE")]
    foxglove_python: Option<PathBuf>,
    /// The bridge to Matter, which is a workspace of its own; tried when it is named. Only root can lay its network
    #[arg(long, value_name = "FILE", requires = "matter_packages")]
    matter: Option<PathBuf>,
    /// The folder in which npm has put matter.js
    #[arg(long, value_name = "FOLDER")]
    matter_packages: Option<PathBuf>,
    /// A Python that has the packages cyclonedds and rosbags
    #[arg(long, value_name = "FILE")]
    ros2_python: Option<PathBuf>,
}

impl Arguments {
    /// Whether what a peer needs was named.
    fn has_what_it_needs(&self, peer: &str) -> bool {
        match peer {
            "home-assistant" => self.hass.is_some(),
            "schemathesis" => self.schemathesis.is_some(),
            "foxglove" => self.foxglove.is_some(),
            "cyclonedds" => self.ros2.is_some(),
            "matter" => self.matter.is_some(),
            _ => true,
        }
    }
}

/// A peer, and how it is tried.
type Trial = (&'static str, fn(&Arguments, &mut Verdict) -> anyhow::Result<()>);

const TRIALS: [Trial; 10] = [
    ("mosquitto", mosquitto::trial),
    ("load", load::trial),
    ("prometheus", prometheus::trial),
    ("python", notifications::trial),
    ("dialect", dialect::trial),
    ("schemathesis", schemathesis::trial),
    ("cyclonedds", ros2::trial),
    ("foxglove", foxglove::trial),
    ("matter", matter::trial),
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
            arguments.has_what_it_needs(name)
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
