//! Hostile clients, ten of each kind, one kind at a time; a line to the robot that fails; a card that takes nothing: how soon Stop of an
//! honest client is answered, how late telemetry comes to it, what the daemon takes of memory and processor, and what becomes of changes.
//!
//! Everybody runs on this machine: on few cores those who besiege take them from the daemon as well. `wait_share` tells how much.

mod card;
mod line;
mod trial;

use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;
use vthal_bench::{HostileKind, needed_beside};

use crate::card::CardState;
use crate::line::LineState;
use crate::trial::{Figures, Trial, Trouble};

#[derive(Parser)]
#[command(about = "Besieges the daemon and measures what an honest client gets of it")]
struct Arguments {
    /// Prints one JSON object
    #[arg(long)]
    json: bool,
    /// So many hostile clients of a kind
    #[arg(long, default_value_t = 10)]
    of_a_kind: u64,
    /// For so long each
    #[arg(long, default_value_t = 10)]
    seconds: u64,
    /// Only the troubles with these names, separated by commas
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
}

fn main() -> ExitCode {
    match measure_all(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("bench-siege: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn measure_all(arguments: &Arguments) -> anyhow::Result<()> {
    let vthal = needed_beside("vthal")?;
    let of_clients = HostileKind::ALL.map(Trouble::Clients);
    let of_line = LineState::ALL.map(Trouble::Line);
    let mut rows = Vec::new();
    let of_card = CardState::ALL.map(Trouble::Card);
    for trouble in of_line.into_iter().chain(of_card).chain(of_clients) {
        if !arguments.only.is_empty() && !arguments.only.iter().any(|name| name == trouble.name()) {
            continue;
        }
        let trial = Trial {
            trouble,
            of_a_kind: arguments.of_a_kind,
            time: Duration::from_secs(arguments.seconds),
        };
        let figures = trial.run(&vthal)?;
        if !arguments.json {
            print_row(trouble, &figures);
        }
        rows.push(as_json(trouble, &figures));
    }
    if arguments.json {
        println!(
            "{}",
            serde_json::json!({"of_a_kind": arguments.of_a_kind, "rows": rows})
        );
    }
    Ok(())
}

fn print_row(trouble: Trouble, figures: &Figures) {
    let telemetry = figures.telemetry_ms.map_or_else(
        || "none comes".to_owned(),
        |delays| format!("p99 {:.0} ms, at most {:.0} ms", delays.p99, delays.most),
    );
    println!(
        "{:20} Stop {} times: median {:.1} ms, p99 {:.1} ms, at most {:.1} ms; telemetry: {telemetry}; {:.1} % of a core, \
         {:.1} % waiting for one, {:.1} MiB, {:.1} lines of log a second",
        trouble.name(),
        figures.stops,
        figures.stop_ms.median,
        figures.stop_ms.p99,
        figures.stop_ms.most,
        figures.cpu_share * 100.0,
        figures.wait_share * 100.0,
        figures.rss_max_mib,
        figures.log_lines_per_s,
    );
    if let Some(passage) = &figures.passage {
        println!("{:20} {:?}", "", passage.answers);
        for line in &passage.told {
            println!("{:20} told: {line}", "");
        }
    }
}

fn as_json(trouble: Trouble, figures: &Figures) -> serde_json::Value {
    serde_json::json!({
        "trouble": trouble.name(),
        "stops": figures.stops,
        "stop_median_ms": figures.stop_ms.median,
        "stop_p99_ms": figures.stop_ms.p99,
        "stop_max_ms": figures.stop_ms.most,
        "telemetry_p99_ms": figures.telemetry_ms.map(|delays| delays.p99),
        "telemetry_max_ms": figures.telemetry_ms.map(|delays| delays.most),
        "cpu_share": figures.cpu_share,
        "wait_share": figures.wait_share,
        "rss_max_mib": figures.rss_max_mib,
        "log_lines_per_s": figures.log_lines_per_s,
        "answers": figures.passage.as_ref().map(|passage| &passage.answers),
        "told": figures.passage.as_ref().map(|passage| &passage.told),
    })
}
