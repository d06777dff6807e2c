//! `cargo xtask bench`: builds what is measured in the release profile and runs it.

mod logic;
mod relax;
mod safety;
mod scripts;

use crate::{codegen, firmware, process, workspace};
use anyhow::Context;
use clap::ValueEnum;
use std::path::PathBuf;

/// What to measure.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Subject {
    /// Corrupted packets through the bit-level channel, cost of the parser; with --kinds each kind of link.
    Link,
    /// The daemon as a relay between a robot and 1, 10 and 100 clients.
    Relay,
    /// The panel's server beside the daemon that it relays: delays, requests a second, memory.
    Panel,
    /// The daemon killed at random moments while a robot drives.
    Kill,
    /// Ten hostile clients of each kind, and a line that fails: how soon Stop is answered, how late telemetry comes, what it takes.
    Siege,
    /// Ten hostile peers of each kind at the TLS port of the panel's server: how soon Stop of a paired phone is answered, how late telemetry
    /// comes, whether a phone that comes anew gets through, and what it takes.
    SiegeTls,
    /// Daemon and panel's server killed at random moments while they write what people entrusted to them.
    Writes,
    /// The simulator against real time with each strategy, and where the time goes.
    Sim,
    /// Packets a second through a script in each language, beside Rust.
    Scripts,
    /// Size of cordlib's state.
    Cordlib,
    /// Every safety rule on the robot's firmware in the emulated chip: worst reactions.
    Safety,
    /// The Relax's image: bytes lost in full duplex, damaged packets, the worst reaction of each rule.
    Relax,
    /// Bits that flip in the robot's firmware's memory and registers.
    Flips,
    /// The robot's firmware in boards with one mistake each: who notices.
    Mutants,
    /// cordlib's reflexes, charger, arming and leases with one expression changed each: which its tests notice.
    LogicMutants,
    /// Edges that flood the receive pin of the robot's firmware.
    Flood,
    /// The robot's firmware charging packs in the emulated chip.
    Charges,
    /// The robot's firmware in the emulated chip beside the built-in one: how well they clean the same home.
    Coverage,
    /// How fast and how surely the robot covers homes, against the lower bound and against bounce.
    Navigation,
    /// What one drive perceived, shown to brains with many seeds: how much of the error of the place is chance.
    Localization,
    /// Run after run in one home, each with what the daemon kept: whether the map gets better or worse.
    Life,
    /// How surely, how fast and how exactly the robot comes home to its dock.
    Docking,
    /// How surely a robot that was put down somewhere finds out on which floor it is.
    Floors,
    /// How soon and how surely a robot that was lifted from its work knows its place again.
    Lifted,
    /// What fails around the Linux board, drawn: whether people are told, soon and rightly, and whether all that was acknowledged is kept.
    Board,
    /// The robot's firmware in the emulated chip: main loop, interrupts, serial line, memory; speed of the emulator.
    Firmware,
}

/// Arguments of `cargo xtask bench`.
#[derive(Debug, clap::Args)]
pub(crate) struct BenchArguments {
    /// What to measure.
    subject: Subject,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Measure longer, for the record.
    #[arg(long)]
    long: bool,
    /// Of `safety`: write the worst figures to protocol/measured.toml, and with them the tables of SAFETY.md.
    #[arg(long, conflicts_with = "check")]
    write: bool,
    /// Of `safety`: fail when a figure is worse than what protocol/measured.toml keeps.
    #[arg(long)]
    check: bool,
    /// Of `docking`: docks that are dirty, dead, moved, turned, recessed, without power, or with a shoe before them.
    #[arg(long)]
    worn: bool,
    /// Of `link`: the kinds of link to measure against the emulated chip, for example `uart,half-duplex,spi,i2c,tcp,usb`.
    #[arg(long)]
    kinds: Option<String>,
    /// Arguments for the measuring program itself, for example `--homes report --seeds 5` of `navigation`.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    rest: Vec<String>,
}

/// Runs the measurement.
pub(crate) fn run(arguments: &BenchArguments) -> anyhow::Result<()> {
    if arguments.kinds.is_some() && !matches!(arguments.subject, Subject::Link) {
        anyhow::bail!("--kinds is for link: cargo xtask bench link --kinds uart,tcp");
    }
    match arguments.subject {
        Subject::Relax => return relax::run(arguments),
        Subject::Scripts => return scripts::run(arguments),
        Subject::LogicMutants => return logic::run(arguments),
        _ => {}
    }
    if matches!(
        arguments.subject,
        Subject::Relay | Subject::Kill | Subject::Siege | Subject::SiegeTls | Subject::Writes
    ) {
        workspace::build(
            &["vthal", "rvac-sim", "panel-server"],
            workspace::Profile::Release,
        )?;
    }
    let firmware = match arguments.subject {
        Subject::Firmware => Some(Firmwares::build()?),
        _ => None,
    };
    let usual = usual_firmware(arguments)?;
    let mut command = workspace::cargo();
    command
        .args(["run", "--release", "--quiet", "--locked"])
        .args(program(arguments))
        .arg("--");
    command.args(fixed(arguments.subject));
    if let Some(firmware) = &firmware {
        firmware.hand_over(&mut command);
    }
    if let Some(elf) = &usual {
        command.arg("--firmware").arg(elf);
    }
    if arguments.json {
        command.arg("--json");
    }
    if arguments.long {
        command.args(longer(arguments));
    }
    if let Some(kinds) = &arguments.kinds {
        name_links(&mut command, kinds)?;
    }
    if arguments.worn {
        command.arg("--worn");
    }
    if matches!(arguments.subject, Subject::Safety) {
        command.args(safety::compared(arguments)?);
    }
    command.args(&arguments.rest);
    process::say(&process::name(&command));
    if let (Some(firmware), true) = (&firmware, arguments.json) {
        return firmware.join(&mut command);
    }
    let status = command.status()?;
    if !status.success() {
        anyhow::bail!("the measurement ended with {status}");
    }
    if arguments.write {
        codegen::run(&codegen::CodegenArguments { check: false })?;
    }
    Ok(())
}

/// The links to measure, with the firmware that each of them needs.
fn name_links(command: &mut std::process::Command, kinds: &str) -> anyhow::Result<()> {
    command.arg("--kinds").arg(kinds);
    for (feature, argument) in firmware::CLOCKED_LINKS {
        if kinds.split(',').any(|kind| feature.ends_with(kind)) {
            command.arg(argument).arg(firmware::elf_with(feature)?);
        }
    }
    Ok(())
}

/// The robot's firmware, where it alone is measured.
fn usual_firmware(arguments: &BenchArguments) -> anyhow::Result<Option<PathBuf>> {
    Ok(match arguments.subject {
        Subject::Link if arguments.kinds.is_some() => Some(firmware::usual_elf()?),
        Subject::Safety
        | Subject::Flips
        | Subject::Mutants
        | Subject::Flood
        | Subject::Charges
        | Subject::Coverage => Some(firmware::usual_elf()?),
        _ => None,
    })
}

/// What is measured in the emulated chip: the robot's firmware, and the one whose main loop does not sleep.
struct Firmwares {
    usual: PathBuf,
    free_running: PathBuf,
}

impl Firmwares {
    fn build() -> anyhow::Result<Self> {
        Ok(Self {
            usual: firmware::usual_elf()?,
            free_running: firmware::free_running_elf()?,
        })
    }

    fn hand_over(&self, command: &mut std::process::Command) {
        command.arg("--firmware").arg(&self.usual);
        command.arg("--free-running").arg(&self.free_running);
    }

    /// Prints one object with what was measured in the chip and what the firmware takes of it; fails when the measurement
    /// does, after that.
    fn join(&self, command: &mut std::process::Command) -> anyhow::Result<()> {
        let output = process::finish(command.stderr(std::process::Stdio::inherit()))?;
        let mut object: serde_json::Value =
            serde_json::from_slice(&output.stdout).context("the measurement gave no figures")?;
        let taken = firmware::report(&self.usual)?;
        for key in ["flash_bytes", "ram_static_bytes", "stack_worst_bytes"] {
            object[key] = taken[key].clone();
        }
        process::print(&serde_json::to_string(&object)?);
        if !output.status.success() {
            anyhow::bail!("the measurement ended with {}", output.status);
        }
        Ok(())
    }
}

fn program(arguments: &BenchArguments) -> &'static [&'static str] {
    match arguments.subject {
        Subject::Link if arguments.kinds.is_some() => &["--bin", "bench-links"],
        Subject::Link => &["--bin", "bench-link"],
        Subject::Relay => &["--bin", "bench-relay"],
        Subject::Panel => &["--bin", "bench-panel"],
        Subject::Kill => &["--bin", "bench-kill"],
        Subject::Siege => &["--bin", "bench-siege"],
        Subject::SiegeTls => &["--bin", "bench-siege-tls"],
        Subject::Writes => &["--bin", "bench-writes"],
        Subject::Sim => &["--bin", "bench-sim"],
        Subject::Cordlib => &["--package", "cordlib", "--example", "size"],
        Subject::Safety => &["--bin", "bench-safety"],
        Subject::Relax => &["--bin", "bench-relax"],
        Subject::Flips => &["--bin", "bench-flips"],
        Subject::Mutants => &["--bin", "bench-mutants"],
        Subject::LogicMutants | Subject::Scripts => &[],
        Subject::Flood => &["--bin", "bench-flood"],
        Subject::Charges => &["--bin", "bench-charges"],
        Subject::Coverage => &["--bin", "bench-coverage"],
        Subject::Navigation => &["--bin", "bench-navigation"],
        Subject::Localization => &["--bin", "bench-localization"],
        Subject::Life => &["--bin", "bench-life"],
        Subject::Docking => &["--bin", "bench-docking"],
        Subject::Floors => &["--bin", "bench-floors"],
        Subject::Lifted => &["--bin", "bench-lifted"],
        Subject::Board => &["--bin", "bench-board"],
        Subject::Firmware => &["--bin", "bench-firmware"],
    }
}

fn fixed(subject: Subject) -> &'static [&'static str] {
    match subject {
        Subject::Sim => &["--parts"],
        Subject::Kill | Subject::Firmware => &["--home", "homes/two-room-flat.toml"],
        Subject::Safety => &["--phases", "20"],
        Subject::Link
        | Subject::Relay
        | Subject::Panel
        | Subject::Siege
        | Subject::SiegeTls
        | Subject::Writes
        | Subject::Cordlib
        | Subject::Relax
        | Subject::Flips
        | Subject::Mutants
        | Subject::LogicMutants
        | Subject::Flood
        | Subject::Charges
        | Subject::Navigation
        | Subject::Localization
        | Subject::Life
        | Subject::Docking
        | Subject::Floors
        | Subject::Lifted
        | Subject::Board
        | Subject::Coverage
        | Subject::Scripts => &[],
    }
}

fn longer(arguments: &BenchArguments) -> &'static [&'static str] {
    match arguments.subject {
        Subject::Link if arguments.kinds.is_some() => &["--seconds", "3600", "--cuts", "200"],
        Subject::Kill => &["--kills", "200"],
        Subject::Writes => &["--kills", "100000"],
        Subject::Safety => &["--phases", "200"],
        Subject::Flips => &["--count", "100000"],
        Subject::Mutants => &["--every-trial"],
        Subject::Flood => &["--count", "40", "--seconds", "10"],
        Subject::Charges => &["--count", "100"],
        Subject::Coverage => &["--minutes", "30", "--seeds", "8"],
        Subject::Navigation => &["--homes", "report", "--seeds", "20"],
        Subject::Localization => &["--homes", "homes/empty-halls.toml,report", "--seeds", "1..20"],
        Subject::Life => &["--homes", "report", "--seeds", "2"],
        Subject::Docking => &["--runs", "1000"],
        Subject::Floors | Subject::Lifted => &["--seeds", "8"],
        Subject::Firmware => &["--flood-seconds", "3600"],
        Subject::Board => &["--seeds", "1000", "--log-hours", "168"],
        Subject::Sim => &["--minutes", "240"],
        Subject::Siege | Subject::SiegeTls => &["--seconds", "60"],
        Subject::Link | Subject::Relay | Subject::Panel => &["--long"],
        Subject::Cordlib | Subject::Relax | Subject::LogicMutants | Subject::Scripts => &[],
    }
}
