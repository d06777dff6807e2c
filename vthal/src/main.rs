//! The daemon on the Linux board, and the replay of its recordings.
#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};
use clap::{Args, CommandFactory, Parser, Subcommand};
use robot_link::LinkAddress;
use vthal::ServeError;
use vthal::config::{self, Overrides};
use vthal::recording::replay::{Replay, replay};

/// Where the configuration is looked for when no flag names it.
const DEFAULT_CONFIG: &str = "/etc/vthal.toml";

#[derive(Parser)]
#[command(
    name = "vthal",
    version,
    about = "Connects a robot's microcontroller, its brain and all clients"
)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Job>,
    #[command(flatten)]
    serve: Serve,
}

#[derive(Subcommand)]
enum Job {
    /// Runs a recording through the same brain again and compares every decision
    Replay {
        /// The recording
        file: PathBuf,
    },
    /// Prints the manual page, for packages
    #[command(hide = true)]
    Manual,
}

#[derive(Args)]
struct Serve {
    /// Configuration (TOML); /etc/vthal.toml if it exists
    #[arg(long)]
    config: Option<PathBuf>,
    /// Link to the robot, such as uart:/dev/serial0, tcp:HOST:PORT or spi:/dev/spidev0.0
    #[arg(long, conflicts_with = "serial")]
    link: Option<LinkAddress>,
    /// Serial device of the robot
    #[arg(long)]
    serial: Option<PathBuf>,
    /// Bits per second
    #[arg(long, value_parser = clap::value_parser!(u32).range(1_200..=4_000_000))]
    baud: Option<u32>,
    /// Path of the Unix socket
    #[arg(long)]
    socket: Option<PathBuf>,
    /// Folder for checkpoints, logs and recordings
    #[arg(long)]
    state: Option<PathBuf>,
    /// Seed of the brain's random decisions
    #[arg(long)]
    seed: Option<u64>,
    /// Clock seconds per real second; only for simulated robots that run as fast
    #[arg(long, default_value_t = 1.0)]
    speed: f64,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match arguments.command {
        Some(Job::Replay { file }) => run_replay(&file),
        Some(Job::Manual) => print_manual(),
        None => run_daemon(arguments.serve),
    };
    result.unwrap_or_else(|error| {
        eprintln!("vthal: {error:#}");
        // systemd does not try again what only a person can mend.
        let needs_a_person =
            error.is::<config::ConfigError>() || matches!(error.downcast_ref(), Some(ServeError::Robot(_)));
        ExitCode::from(if needs_a_person { 2 } else { 1 })
    })
}

fn run_daemon(serve: Serve) -> anyhow::Result<ExitCode> {
    if !(serve.speed.is_finite() && serve.speed > 0.0 && serve.speed <= 1000.0) {
        bail!(
            "--speed {} is out of range: give a number above 0, at most 1000",
            serve.speed
        );
    }
    let default = Path::new(DEFAULT_CONFIG);
    let path = serve.config.as_deref().or(default.exists().then_some(default));
    let overrides = Overrides {
        link: serve.link,
        serial: serve.serial,
        baud: serve.baud,
        socket: serve.socket,
        state: serve.state,
        seed: serve.seed,
    };
    let config = config::load(path, overrides)?;
    vthal::serve(&config, serve.speed)?;
    Ok(ExitCode::SUCCESS)
}

fn print_manual() -> anyhow::Result<ExitCode> {
    clap_mangen::Man::new(Arguments::command()).render(&mut std::io::stdout())?;
    Ok(ExitCode::SUCCESS)
}

fn run_replay(file: &Path) -> anyhow::Result<ExitCode> {
    let Replay {
        steps,
        truncated,
        difference,
    } = replay(file).context("replay")?;
    let ending = if truncated {
        "; the file ends in the middle, what is whole was replayed"
    } else {
        ""
    };
    match difference {
        None => {
            println!("identical: {steps} steps{ending}");
            Ok(ExitCode::SUCCESS)
        }
        Some(difference) => {
            println!(
                "first difference at step {} ({:.3} s)",
                difference.step,
                difference.time_us as f64 * 1e-6
            );
            println!("recorded: {}", difference.recorded);
            println!("replayed: {}", difference.replayed);
            Ok(ExitCode::FAILURE)
        }
    }
}
