//! Hostile peers at the TLS port of the panel's server, ten of each kind, one kind at a time: how soon Stop of an honest paired phone is
//! answered, how late telemetry comes to another, whether a third gets through that comes anew each second, and what server and daemon take.
//!
//! Everybody runs on this machine: on few cores those who besiege take them from the server and the daemon as well. `wait_share` tells how
//! much. A robot of our own is at the daemon's terminal, so that its clock is this program's.

mod honest;
mod hostile;
mod trial;

use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;

use crate::hostile::Kind;
use crate::trial::{Figures, Taken, Trial};

#[derive(Parser)]
#[command(about = "Besieges the panel's server and measures what honest phones get of it")]
struct Arguments {
    /// Prints one JSON object
    #[arg(long)]
    json: bool,
    /// So many hostile peers of a kind
    #[arg(long, default_value_t = 10)]
    of_a_kind: u64,
    /// For so long each
    #[arg(long, default_value_t = 10)]
    seconds: u64,
    /// Only the kinds with these names, separated by commas
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
}

fn main() -> ExitCode {
    match measure_all(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("bench-siege-tls: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn measure_all(arguments: &Arguments) -> anyhow::Result<()> {
    let mut rows = Vec::new();
    for kind in Kind::ALL {
        if !arguments.only.is_empty() && !arguments.only.iter().any(|name| name == kind.name()) {
            continue;
        }
        let trial = Trial {
            kind,
            of_a_kind: arguments.of_a_kind,
            time: Duration::from_secs(arguments.seconds),
        };
        let row = match trial.run() {
            Ok(figures) => {
                if !arguments.json {
                    print_row(kind, &figures);
                }
                as_json(kind, &figures)
            }
            // That honest phones are lost is a figure, too.
            Err(error) => {
                if !arguments.json {
                    println!("{:20} {error:#}", kind.name());
                }
                serde_json::json!({"trouble": kind.name(), "failed": format!("{error:#}")})
            }
        };
        rows.push(row);
    }
    if arguments.json {
        println!(
            "{}",
            serde_json::json!({"of_a_kind": arguments.of_a_kind, "rows": rows})
        );
    }
    Ok(())
}

fn print_row(kind: Kind, figures: &Figures) {
    let newcomer = figures.newcomer_ms.map_or_else(
        || "none got through".to_owned(),
        |delays| format!("median {:.0} ms, at most {:.0} ms", delays.median, delays.most),
    );
    println!(
        "{:20} Stop {} times: median {:.1} ms, p99 {:.1} ms, at most {:.1} ms; telemetry: p99 {:.0} ms, at most {:.0} ms; \
         {} newcomers: {newcomer}, {} lost; server {}; daemon {}; {} connections, {} refused, {} requests",
        kind.name(),
        figures.stops,
        figures.stop_ms.median,
        figures.stop_ms.p99,
        figures.stop_ms.most,
        figures.telemetry_ms.p99,
        figures.telemetry_ms.most,
        figures.newcomers,
        figures.lost_newcomers.len(),
        in_words(figures.server),
        in_words(figures.daemon),
        figures.connections,
        figures.refused,
        figures.requests,
    );
    for lost in &figures.lost_newcomers {
        println!("{:20} lost: {lost}", "");
    }
}

fn in_words(taken: Taken) -> String {
    format!(
        "{:.0} % of a core, {:.0} % waiting for one, {:.1} MiB",
        taken.cpu_share * 100.0,
        taken.wait_share * 100.0,
        taken.rss_max_mib
    )
}

fn as_json(kind: Kind, figures: &Figures) -> serde_json::Value {
    let of = |taken: Taken| {
        serde_json::json!({
            "cpu_share": taken.cpu_share, "wait_share": taken.wait_share, "rss_max_mib": taken.rss_max_mib,
        })
    };
    serde_json::json!({
        "trouble": kind.name(),
        "stops": figures.stops,
        "stop_median_ms": figures.stop_ms.median,
        "stop_p99_ms": figures.stop_ms.p99,
        "stop_max_ms": figures.stop_ms.most,
        "telemetry_p99_ms": figures.telemetry_ms.p99,
        "telemetry_max_ms": figures.telemetry_ms.most,
        "newcomers": figures.newcomers,
        "newcomer_median_ms": figures.newcomer_ms.map(|delays| delays.median),
        "newcomer_max_ms": figures.newcomer_ms.map(|delays| delays.most),
        "lost_newcomers": figures.lost_newcomers,
        "server": of(figures.server),
        "daemon": of(figures.daemon),
        "connections": figures.connections,
        "refused": figures.refused,
        "requests": figures.requests,
    })
}
