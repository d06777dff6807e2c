//! Measures the link: wrong actuations from a damaged line, and what reading a packet costs.

mod corruption;
mod cost;
mod traffic;

use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};
use serde_json::json;

/// Packets of a normal run.
const PACKETS: u64 = 10_000_000;
/// Packets of a long run.
const PACKETS_LONG: u64 = 100_000_000;

#[derive(Parser)]
#[command(about = "Counts wrong actuations over a damaged line and measures the cost of a packet")]
struct Arguments {
    /// Ten times as many packets: 10^8.
    #[arg(long)]
    long: bool,
    /// How many corrupted packets, instead of 10^7.
    #[arg(long, conflicts_with = "long")]
    packets: Option<u64>,
    /// Seed of all faults.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
    #[command(subcommand)]
    part: Option<Part>,
}

#[derive(Subcommand)]
enum Part {
    /// Reads one kind of packet again and again, for counting instructions under callgrind.
    Repeat {
        /// Which; see the names in the table of costs.
        reader: String,
        /// How often.
        count: u64,
    },
}

fn main() -> Result<ExitCode> {
    let arguments = Arguments::parse();
    if let Some(Part::Repeat { reader, count }) = &arguments.part {
        cost::repeat(reader, *count)?;
        return Ok(ExitCode::SUCCESS);
    }
    let packets = match (arguments.long, arguments.packets) {
        (true, _) => PACKETS_LONG,
        (false, Some(packets)) => packets,
        (false, None) => PACKETS,
    };
    let corruption = corruption::run(packets, arguments.seed);
    let costs = cost::measure()?;
    if arguments.json {
        let report = json!({
            "corrupted_packets": corruption.corrupted_packets(),
            "wrong_actuations": corruption.wrong_actuations(),
            "valid_packets": corruption.valid_packets,
            "valid_packets_lost": corruption.valid_packets_lost,
            "fault_kinds": corruption.kinds,
            "costs": costs,
        });
        println!("{report}");
    } else {
        corruption.print();
        cost::print(&costs);
    }
    let clean = corruption.wrong_actuations() == 0 && corruption.valid_packets_lost == 0;
    Ok(if clean {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}
