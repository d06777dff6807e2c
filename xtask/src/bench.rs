//! `cargo xtask bench`: builds what is measured in the release profile and runs it.

use crate::{process, workspace};
use clap::ValueEnum;

/// What to measure.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Subject {
    /// Corrupted packets through the bit-level channel; cost of the parser.
    Link,
    /// The daemon as a relay between a robot and 1, 10 and 100 clients.
    Relay,
    /// The daemon killed at random moments while a robot drives.
    Kill,
    /// The simulator against real time.
    Sim,
    /// Size of cordlib's state.
    Cordlib,
}

/// Arguments of `cargo xtask bench`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// What to measure.
    subject: Subject,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Measure longer, for the record.
    #[arg(long)]
    long: bool,
    /// Arguments for the measuring program itself.
    #[arg(last = true)]
    rest: Vec<String>,
}

/// Runs the measurement.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    if matches!(arguments.subject, Subject::Relay | Subject::Kill) {
        workspace::build(&["vthal", "rvac-sim"], workspace::Profile::Release)?;
    }
    let mut command = workspace::cargo();
    command
        .args(["run", "--release", "--quiet", "--locked"])
        .args(program(arguments.subject))
        .arg("--");
    command.args(fixed(arguments.subject));
    if arguments.json {
        command.arg("--json");
    }
    if arguments.long {
        command.args(longer(arguments.subject));
    }
    command.args(&arguments.rest);
    process::say(&process::name(&command));
    let status = command.status()?;
    if !status.success() {
        anyhow::bail!("the measurement ended with {status}");
    }
    Ok(())
}

fn program(subject: Subject) -> &'static [&'static str] {
    match subject {
        Subject::Link => &["--package", "rvac-channel", "--bin", "bench-link"],
        Subject::Relay => &["--package", "vthal", "--bin", "bench-relay"],
        Subject::Kill => &["--package", "vthal", "--bin", "bench-kill"],
        Subject::Sim => &["--package", "rvac-sim"],
        Subject::Cordlib => &["--package", "cordlib", "--example", "size"],
    }
}

fn fixed(subject: Subject) -> &'static [&'static str] {
    match subject {
        Subject::Sim => &[
            "run",
            "--home",
            "homes/two-room-flat.toml",
            "--robot",
            "sr8730",
            "--strategy",
            "bounce",
            "--minutes",
            "60",
        ],
        Subject::Kill => &["--home", "homes/two-room-flat.toml"],
        Subject::Link | Subject::Relay | Subject::Cordlib => &[],
    }
}

fn longer(subject: Subject) -> &'static [&'static str] {
    match subject {
        Subject::Kill => &["--kills", "200"],
        Subject::Link | Subject::Relay => &["--long"],
        Subject::Sim | Subject::Cordlib => &[],
    }
}
