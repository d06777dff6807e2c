//! `bench-mutants`: boards with one mistake each, and who notices. `cargo xtask bench mutants` builds and runs it.
#![forbid(unsafe_code)]

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use trials::wiring::{Mistake, Noticed, notice};
use trials::{CampaignError, Fixture, Trial, conclude, trials};

/// Share of the mistakes that must be noticed.
const NOTICED_SHARE: f64 = 0.95;

/// Puts a firmware into boards with one mistake each.
#[derive(Debug, Parser)]
#[command(args_override_self = true)]
struct Arguments {
    /// The firmware, as ELF.
    #[arg(long)]
    firmware: PathBuf,
    /// Moments at which each trial's event happens.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1_000))]
    phases: u32,
    /// Only mistakes whose name contains this.
    #[arg(long)]
    only: Option<String>,
    /// Only this trial; may be given several times.
    #[arg(long)]
    trial: Vec<String>,
    /// Print JSON, one object a line.
    #[arg(long)]
    json: bool,
}

fn main() -> ExitCode {
    conclude(
        "bench-mutants",
        run(&Arguments::parse()),
        "too many mistakes were not noticed",
    )
}

fn run(arguments: &Arguments) -> Result<bool, CampaignError> {
    let fixture = Fixture::open(&arguments.firmware)?;
    let wanted =
        |trial: &Trial| arguments.trial.is_empty() || arguments.trial.iter().any(|name| name == trial.name);
    let chosen: Vec<Trial> = trials().into_iter().filter(wanted).collect();
    let mut out = io::stdout().lock();
    let (mut made, mut noticed) = (0_u32, 0_u32);
    for mistake in Mistake::all() {
        let is_asked = arguments
            .only
            .as_ref()
            .is_none_or(|part| mistake.name().contains(part));
        if !is_asked {
            continue;
        }
        let result = notice(&fixture, &mistake, &chosen, arguments.phases as usize);
        made += 1;
        noticed += u32::from(!result.by.is_empty());
        tell(&mut out, arguments, &result)?;
    }
    if arguments.json {
        let sum = serde_json::json!({"made": made, "noticed": noticed, "survivors": made - noticed});
        writeln!(out, "{sum}")?;
    } else {
        writeln!(out, "{noticed} of {made} mistakes were noticed")?;
    }
    Ok(made > 0 && f64::from(noticed) >= NOTICED_SHARE * f64::from(made))
}

fn tell(out: &mut impl Write, arguments: &Arguments, result: &Noticed) -> io::Result<()> {
    if arguments.json {
        serde_json::to_writer(&mut *out, result).map_err(io::Error::from)?;
        return writeln!(out);
    }
    let by = match result.by.as_slice() {
        [] => "NOBODY".to_owned(),
        [only] => only.clone(),
        [first, rest @ ..] => format!("{first} and {} more", rest.len()),
    };
    writeln!(out, "{:<56} {by}", result.mistake)?;
    out.flush()
}
