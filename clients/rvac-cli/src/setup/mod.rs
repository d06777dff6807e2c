//! `rvac setup`: from an installed package to a robot that answers; and `rvac doctor`, which looks at the same things later.

mod answering;
mod configure;
mod doctor;
mod find;
mod start;

use std::io::{IsTerminal as _, Write as _, stdin, stdout};
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;

use crate::arguments::SetupOptions;
use crate::board::{Board, candidates};
use find::{Answering, Heard, Silence};

pub(crate) use doctor::run as doctor;

/// Leads from checks to a running robot.
pub(crate) fn run(options: &SetupOptions) -> anyhow::Result<ExitCode> {
    let board = Board::below(&options.root);
    if board.path(configure::FILE).exists() && !options.anew {
        say(
            "/etc/vthal.toml is there already and stays as it is; --anew makes another and keeps this one as /etc/vthal.toml.old.",
        )?;
    } else {
        let Some(robot) = robot(&board, options)? else {
            return Ok(ExitCode::FAILURE);
        };
        let question = format!("Configure a {} on {}?", robot.model, robot.serial.display());
        if !agreed(&question, options.yes)? {
            return Ok(ExitCode::FAILURE);
        }
        configure::write(&board, &robot)?;
        say("wrote /etc/vthal.toml")?;
    }
    start::services(&board)?;
    doctor::print(&doctor::findings(&board, &options.daemon, &options.console))?;
    start::show_way_in(&options.console)
}

/// A robot, and where it is.
#[derive(Debug)]
struct Chosen {
    model: String,
    serial: PathBuf,
    /// The rate at which it answered; none for a robot that does not answer yet.
    baud: Option<u32>,
}

/// The robot that answers; or the one that the person names, if none does.
fn robot(board: &Board, options: &SetupOptions) -> anyhow::Result<Option<Chosen>> {
    let devices = match &options.serial {
        Some(path) => vec![path.clone()],
        None => candidates(board).into_iter().map(|device| device.path).collect(),
    };
    if devices.is_empty() {
        bail!(
            "this board has no serial device: plug the adapter in, or switch the pins' serial port on \
             (on a Raspberry Pi enable_uart=1 in config.txt), and start again; --serial names another device"
        );
    }
    let mut silent = Vec::new();
    for device in &devices {
        say(&format!("looks for a robot on {} ...", device.display()))?;
        match find::look(&board.path(&device.to_string_lossy())) {
            Heard::Robot(Answering { device: name, baud }) => {
                say(&format!("{name} answers on {} at {baud} baud", device.display()))?;
                return Ok(Some(Chosen {
                    model: name,
                    serial: device.clone(),
                    baud: Some(baud),
                }));
            }
            Heard::Nothing(silence) => silent.push((device, silence)),
        }
    }
    for (device, silence) in &silent {
        say(&format!("{}: {}", device.display(), silence.in_words()))?;
    }
    named(options, &silent)
}

fn named(options: &SetupOptions, silent: &[(&PathBuf, Silence)]) -> anyhow::Result<Option<Chosen>> {
    let serial = match silent {
        [(device, _), ..] => (*device).clone(),
        [] => bail!("no serial device could be tried"),
    };
    if let Some(model) = &options.model {
        return Ok(Some(Chosen {
            model: model.clone(),
            serial,
            baud: None,
        }));
    }
    say(
        "No robot answers. Check that it is switched on, that its lines cross (its transmit to the board's receive), that both share a ground, \
         and that LibreRVAC's firmware is in it. To go on without it: rvac setup --model sr8730, or relax",
    )?;
    Ok(None)
}

/// Whether the person agrees; without a terminal and without --yes nobody does.
fn agreed(question: &str, yes: bool) -> anyhow::Result<bool> {
    if yes {
        return Ok(true);
    }
    if !stdin().is_terminal() {
        bail!("{question} Nobody is there to answer: start it in a terminal, or with --yes");
    }
    let mut out = stdout().lock();
    write!(out, "{question} [Y/n] ")?;
    out.flush()?;
    let mut line = String::new();
    stdin().read_line(&mut line)?;
    Ok(matches!(line.trim().to_lowercase().as_str(), "" | "y" | "yes"))
}

fn say(line: &str) -> std::io::Result<()> {
    writeln!(stdout(), "{line}")
}
