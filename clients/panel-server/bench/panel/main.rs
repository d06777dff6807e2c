//! Measures the panel's server: a robot at a pseudo terminal, the real daemon, the real server in front of it, once for this
//! computer only and once over TLS for paired devices, and clients that follow all that a page follows.
//!
//! Beside them the same number of clients are at the daemon's own socket in the same seconds: what the server adds is the
//! difference.

mod peer;
mod requests;
mod stage;
mod telemetry;

use std::process::{Command, ExitCode};
use std::time::Duration;

use anyhow::{Context, bail};
use clap::Parser;
use stage::Stage;
use vthal_bench::{Processor, resident_max_mib, resident_mib};

/// Numbers of clients of each route.
const CLIENTS: [usize; 2] = [1, 10];

#[derive(Parser)]
#[command(about = "Measures the panel's server beside the daemon that it relays")]
struct Arguments {
    /// Prints one JSON object
    #[arg(long)]
    json: bool,
    /// Measures for longer
    #[arg(long)]
    long: bool,
}

fn main() -> ExitCode {
    match measure_all(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("bench-panel: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn measure_all(arguments: &Arguments) -> anyhow::Result<()> {
    build_beside()?;
    let time = Duration::from_secs(if arguments.long { 60 } else { 10 });
    let mut rows = Vec::new();
    for clients in CLIENTS {
        for row in measure(clients, time).with_context(|| format!("{clients} clients"))? {
            if !arguments.json {
                println!("{}", row.as_text());
            }
            rows.push(row.as_json());
        }
    }
    if arguments.json {
        println!("{}", serde_json::json!({"state_hz": 50, "rows": rows}));
    }
    Ok(())
}

/// What was measured on one route to the robot.
struct Row {
    route: &'static str,
    clients: usize,
    telemetry: telemetry::Delays,
    requests: requests::Figures,
    /// None of the daemon, which all routes use at once.
    server: Option<Server>,
}

/// What the server took while telemetry came.
struct Server {
    cpu_share: f64,
    /// With all clients connected and the map sent.
    resident_mib: f64,
    /// The most, at the end.
    resident_max_mib: f64,
}

fn measure(clients: usize, time: Duration) -> anyhow::Result<Vec<Row>> {
    let mut stage = Stage::set()?;
    let routes = stage.routes();
    let processes: Vec<Option<u32>> = routes.iter().map(|route| route.process).collect();
    let before = usage(&processes)?;
    let delays = telemetry::measure(&mut stage, &routes, clients, time)?;
    let after = usage(&processes)?;
    let resident: Vec<Option<f64>> = map_each(&processes, resident_mib)?;
    let mut rows = Vec::new();
    let all = routes
        .iter()
        .zip(&processes)
        .zip(delays)
        .zip(before.iter().zip(after))
        .zip(resident);
    for ((((route, process), telemetry), (before, after)), resident) in all {
        let requests = requests::measure(&mut stage, route, clients, time / 2)?;
        let server = match (process, before, after, resident) {
            (Some(process), Some(before), Some(after), Some(resident_mib)) => Some(Server {
                cpu_share: (after.ran_s - before.ran_s) / telemetry.took.as_secs_f64(),
                resident_mib,
                resident_max_mib: resident_max_mib(*process)?,
            }),
            _ => None,
        };
        rows.push(Row {
            route: route.name,
            clients,
            telemetry,
            requests,
            server,
        });
    }
    Ok(rows)
}

fn usage(processes: &[Option<u32>]) -> anyhow::Result<Vec<Option<Processor>>> {
    map_each(processes, Processor::of)
}

fn map_each<T>(
    processes: &[Option<u32>],
    of: impl Fn(u32) -> std::io::Result<T>,
) -> anyhow::Result<Vec<Option<T>>> {
    let each = processes.iter().map(|process| process.map(&of).transpose());
    Ok(each.collect::<std::io::Result<_>>()?)
}

/// `cargo run` builds only what it runs; the programs of the same profile may still be missing or old.
fn build_beside() -> anyhow::Result<()> {
    let Some(cargo) = std::env::var_os("CARGO") else {
        return Ok(());
    };
    let mut command = Command::new(cargo);
    command.args(["build", "--quiet", "--bin", "vthal", "--bin", "panel-server"]);
    if !cfg!(debug_assertions) {
        command.arg("--release");
    }
    if !command.status().context("cargo build")?.success() {
        bail!("vthal and panel-server could not be built");
    }
    Ok(())
}

impl Row {
    fn as_text(&self) -> String {
        let server = self.server.as_ref().map_or_else(String::new, |server| {
            format!(
                "; server: {:.2} % of a core, {:.1} MiB, at most {:.1} MiB",
                server.cpu_share * 100.0,
                server.resident_mib,
                server.resident_max_mib
            )
        });
        format!(
            "{:13} {:3} clients: telemetry at 50 Hz: median {:.2} ms, p99 {:.2} ms; {:6.0} requests/s, median {:.2} ms, p99 {:.2} ms{server}",
            self.route,
            self.clients,
            self.telemetry.median_ms,
            self.telemetry.p99_ms,
            self.requests.per_s,
            self.requests.median_ms,
            self.requests.p99_ms,
        )
    }

    fn as_json(&self) -> serde_json::Value {
        serde_json::json!({
            "way": self.route,
            "clients": self.clients,
            "telemetry_median_ms": self.telemetry.median_ms,
            "telemetry_p99_ms": self.telemetry.p99_ms,
            "requests_per_s": self.requests.per_s,
            "request_median_ms": self.requests.median_ms,
            "request_p99_ms": self.requests.p99_ms,
            "server_cpu_share": self.server.as_ref().map(|server| server.cpu_share),
            "server_rss_mib": self.server.as_ref().map(|server| server.resident_mib),
            "server_rss_max_mib": self.server.as_ref().map(|server| server.resident_max_mib),
        })
    }
}
