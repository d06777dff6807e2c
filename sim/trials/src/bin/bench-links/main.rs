//! `bench-links`: each kind of link between a host and the robot's firmware in the emulated chip: what is lost, what is late, and
//! whether the wheels stand when the cable is out. `cargo xtask bench link --kinds uart,tcp` builds and runs it.
#![forbid(unsafe_code)]

mod desk;
mod wire;

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use desk::{Measured, Trial};
use wire::LinkKind;

/// Measures links against a firmware in the emulated chip.
#[derive(Debug, Parser)]
struct Arguments {
    /// The firmware, as ELF.
    #[arg(long)]
    firmware: PathBuf,
    /// Floor plan.
    #[arg(long, default_value = "homes/two-room-flat.toml")]
    home: PathBuf,
    /// Links to measure.
    #[arg(long, value_delimiter = ',', default_value = "uart,half-duplex,tcp,usb")]
    kinds: Vec<LinkKind>,
    /// Simulated seconds of each, half of them with noise.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(2..=86_400))]
    seconds: u64,
    /// Moments at which the cable comes out.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    cuts: u32,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match measure(&arguments) {
        Ok(faults) if faults.is_empty() => ExitCode::SUCCESS,
        Ok(faults) => complain(&faults.join("; ")),
        Err(error) => complain(&format!("{error:#}")),
    }
}

/// Measures each link and prints the figures; gives what should not be.
fn measure(arguments: &Arguments) -> anyhow::Result<Vec<String>> {
    let trial = Trial::open(&arguments.firmware, &arguments.home)?;
    let mut links = Vec::new();
    for kind in &arguments.kinds {
        links.push(trial.measure(*kind, arguments.seconds, arguments.cuts)?);
    }
    let mut out = io::stdout();
    if arguments.json {
        let object = serde_json::json!({ "links": links });
        writeln!(out, "{object}")?;
    } else {
        writeln!(out, "{}", table(&links))?;
    }
    Ok(links.iter().flat_map(Measured::faults).collect())
}

fn table(links: &[Measured]) -> String {
    let head = "link         lost bytes  wrong packets  p99 ms  telemetry Hz  chip busy %  stands after ms\n";
    links.iter().fold(head.to_owned(), |all, link| {
        all + &format!(
            "{:12} {:10}  {:13}  {:6}  {:12.1}  {:11.1}  {:15}\n",
            link.kind,
            link.lost_bytes,
            link.wrong_packets,
            link.p99_ms,
            link.telemetry_hz,
            link.cpu_percent,
            link.stands_ms
        )
    })
}

fn complain(what: &str) -> ExitCode {
    // If standard error is closed, the message is lost.
    writeln!(io::stderr(), "bench-links: {what}").ok();
    ExitCode::FAILURE
}
