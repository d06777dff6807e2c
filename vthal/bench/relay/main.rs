//! Measures the daemon as a relay: a robot at a real pseudo terminal, the real binary, and 1, 10 and 100 clients.
//!
//! Beside it runs a *plain* relay in a process of its own, which copies bytes from the terminal to every client and
//! understands nothing: what it costs is what any relay on this machine costs.

mod measure;
#[path = "../peer/mod.rs"]
mod peer;
mod plain;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Duration;

use anyhow::{Context, bail};
use clap::{Parser, Subcommand};
use measure::{Figures, Relay, Trial};
use peer::{Daemon, Scratch, built_beside};

/// Numbers of clients.
const CLIENTS: [usize; 3] = [1, 10, 100];

#[derive(Parser)]
#[command(about = "Measures vthal as a relay between a robot and its clients")]
struct Arguments {
    #[command(subcommand)]
    role: Option<Role>,
    /// Prints one JSON object
    #[arg(long)]
    json: bool,
    /// Measures for longer
    #[arg(long)]
    long: bool,
}

#[derive(Subcommand)]
enum Role {
    /// Is the plain relay
    #[command(hide = true)]
    Plain {
        #[arg(long)]
        serial: PathBuf,
        #[arg(long)]
        socket: PathBuf,
    },
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match &arguments.role {
        Some(Role::Plain { serial, socket }) => plain::serve(serial, socket),
        None => measure_all(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("bench-relay: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn measure_all(arguments: &Arguments) -> anyhow::Result<()> {
    let vthal = build_vthal()?;
    let time = Duration::from_secs(if arguments.long { 20 } else { 4 });
    let mut rows = Vec::new();
    for relay in [Relay::Vthal, Relay::Plain] {
        for clients in CLIENTS {
            let trial = Trial { relay, clients, time };
            let figures = run_trial(&trial, &vthal)
                .with_context(|| format!("{} with {clients} clients", relay.name()))?;
            if !arguments.json {
                print_row(&trial, &figures);
            }
            rows.push(as_json(&trial, &figures));
        }
    }
    if arguments.json {
        let profile = if cfg!(debug_assertions) {
            "debug"
        } else {
            "release"
        };
        println!(
            "{}",
            serde_json::json!({"profile": profile, "state_hz": 50, "rows": rows})
        );
    }
    Ok(())
}

fn run_trial(trial: &Trial, vthal: &Path) -> anyhow::Result<Figures> {
    let scratch = Scratch::new()?;
    let robot = measure::switch_on(&scratch)?;
    let daemon = match trial.relay {
        Relay::Vthal => Daemon::start(vthal, &scratch, &["--seed", "1"])?,
        Relay::Plain => start_plain(&scratch)?,
    };
    measure::run(trial, (robot, &daemon), &scratch.join("vthal.sock"))
}

fn start_plain(scratch: &Scratch) -> anyhow::Result<Daemon> {
    let mut command = Command::new(std::env::current_exe()?);
    command.arg("plain").arg("--serial").arg(scratch.join("tty"));
    command.arg("--socket").arg(scratch.join("vthal.sock"));
    Ok(Daemon::start_command(command)?)
}

/// `cargo run` builds only what it runs; the daemon of the same profile may still be missing or old.
fn build_vthal() -> anyhow::Result<PathBuf> {
    if let Some(cargo) = std::env::var_os("CARGO") {
        let mut command = Command::new(cargo);
        command.args(["build", "--quiet", "--package", "vthal", "--bin", "vthal"]);
        if !cfg!(debug_assertions) {
            command.arg("--release");
        }
        if !command.status().context("cargo build")?.success() {
            bail!("vthal could not be built");
        }
    }
    built_beside("vthal")?.context("vthal is not built beside this program: cargo build -p vthal")
}

fn print_row(trial: &Trial, figures: &Figures) {
    println!(
        "{:5} {:3} clients: {:7.0} packets/s to each; at 50 Hz: latency median {:4.0} us, p99 {:4.0} us; \
         {:.2} % of a core, {:.1} MiB",
        trial.relay.name(),
        trial.clients,
        figures.packets_per_s,
        figures.latency_median_us,
        figures.latency_p99_us,
        figures.cpu_share * 100.0,
        figures.rss_mib,
    );
}

fn as_json(trial: &Trial, figures: &Figures) -> serde_json::Value {
    serde_json::json!({
        "relay": trial.relay.name(),
        "clients": trial.clients,
        "packets_per_s": figures.packets_per_s,
        "latency_median_us": figures.latency_median_us,
        "latency_p99_us": figures.latency_p99_us,
        "cpu_share": figures.cpu_share,
        "rss_mib": figures.rss_mib,
    })
}
