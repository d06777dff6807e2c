//! `bench-links`: each kind of link between a host and the robot's firmware in the emulated chip: what is lost, what is late, and
//! whether the wheels stand when the cable is out. `cargo xtask bench link --kinds uart,tcp` builds and runs it.
#![forbid(unsafe_code)]

mod bus;
mod desk;
mod measured;
mod wire;

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context;
use clap::Parser;
use desk::Trial;
use measured::Measured;
use pic32::board::BoardLink;
use wire::LinkKind;

/// Measures links against a firmware in the emulated chip.
#[derive(Debug, Parser)]
struct Arguments {
    /// The firmware with a serial link, as ELF.
    #[arg(long)]
    firmware: PathBuf,
    /// The firmware with its link by SPI.
    #[arg(long)]
    firmware_spi: Option<PathBuf>,
    /// The firmware with its link by I2C.
    #[arg(long)]
    firmware_i2c: Option<PathBuf>,
    /// Floor plan.
    #[arg(long, default_value = "homes/two-room-flat.toml")]
    home: PathBuf,
    /// Links to measure.
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "uart,half-duplex,spi,i2c,tcp,usb"
    )]
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

impl Arguments {
    /// The firmware that was built for a kind of link.
    fn firmware(&self, kind: LinkKind) -> anyhow::Result<&Path> {
        let (path, argument) = match kind.at_the_board() {
            BoardLink::Serial => return Ok(&self.firmware),
            BoardLink::Spi => (&self.firmware_spi, "--firmware-spi"),
            BoardLink::I2c => (&self.firmware_i2c, "--firmware-i2c"),
        };
        path.as_deref().with_context(|| {
            format!(
                "{} needs {argument}: a firmware that was built for it",
                kind.name()
            )
        })
    }
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
    let mut links = Vec::new();
    for kind in &arguments.kinds {
        let trial = Trial::open(arguments.firmware(*kind)?, kind.at_the_board(), &arguments.home)?;
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
    let head = "link         lost bytes  wrong packets  p99 ms  telemetry Hz  asked for Hz  chip busy %  stands after ms\n";
    links.iter().fold(head.to_owned(), |all, link| {
        all + &format!(
            "{:12} {:10}  {:13}  {:6}  {:12.1}  {:12.1}  {:11.1}  {:15}\n",
            link.kind,
            link.lost_bytes,
            link.wrong_packets,
            link.p99_ms,
            link.telemetry_hz,
            link.telemetry_max_hz,
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
