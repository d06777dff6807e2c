//! Measures the daemon as a relay: a robot at a real pseudo terminal, the real binary, and 1, 10 and 100 clients.
//!
//! Beside it runs a *plain* relay in a process of its own, which copies bytes from the terminal to every client and
//! understands nothing: what it costs is what any relay on this machine costs. Both are measured in the same seconds,
//! a packet through one and then a packet through the other, because other programs delay them both.

mod lane;
mod measure;
mod plain;
mod reader;

use std::path::PathBuf;
use std::process::{Command, ExitCode};
use std::time::Duration;

use anyhow::{Context, bail};
use clap::{Parser, Subcommand};
use lane::{Lane, Relay};
use measure::Figures;
use vthal_bench::needed_beside;

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
    let time = Duration::from_secs(if arguments.long { 60 } else { 10 });
    let load_before = load()?;
    let mut rows = Vec::new();
    for clients in CLIENTS {
        let relays = [Relay::Plain, Relay::Vthal];
        let lanes = relays.map(|relay| Lane::start(relay, clients, &vthal));
        let lanes = lanes.into_iter().collect::<anyhow::Result<Vec<_>>>()?;
        let all = measure::run(lanes, time).with_context(|| format!("{clients} clients"))?;
        for (relay, figures) in relays.into_iter().zip(&all) {
            if !arguments.json {
                print_row(relay, clients, figures);
            }
            rows.push(as_json(relay, clients, figures));
        }
    }
    let loads = [load_before, load()?];
    if arguments.json {
        let profile = if cfg!(debug_assertions) {
            "debug"
        } else {
            "release"
        };
        println!(
            "{}",
            serde_json::json!({"profile": profile, "state_hz": 50, "load_average": loads, "rows": rows})
        );
    } else {
        println!(
            "load average of the machine: {} before, {} after",
            loads[0], loads[1]
        );
    }
    Ok(())
}

/// Programs that ran or wanted to, on average over the last minute.
fn load() -> anyhow::Result<f64> {
    let text = std::fs::read_to_string("/proc/loadavg")?;
    let word = text.split(' ').next().context("no load in /proc")?;
    Ok(word.parse()?)
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
    needed_beside("vthal")
}

fn print_row(relay: Relay, clients: usize, figures: &Figures) {
    println!(
        "{:5} {clients:3} clients: {:7.0} packets/s to each; at 50 Hz: latency median {:4.0} us, p99 {:4.0} us; \
         {:.2} % of a core, {:.2} % waiting for one, {:.1} MiB",
        relay.name(),
        figures.packets_per_s,
        figures.latency_median_us,
        figures.latency_p99_us,
        figures.cpu_share * 100.0,
        figures.wait_share * 100.0,
        figures.rss_mib,
    );
}

fn as_json(relay: Relay, clients: usize, figures: &Figures) -> serde_json::Value {
    serde_json::json!({
        "relay": relay.name(),
        "clients": clients,
        "packets_per_s": figures.packets_per_s,
        "latency_median_us": figures.latency_median_us,
        "latency_p99_us": figures.latency_p99_us,
        "cpu_share": figures.cpu_share,
        "wait_share": figures.wait_share,
        "rss_mib": figures.rss_mib,
    })
}
