//! `rvac term`: a person types packets to the robot.

mod direct;
mod relay;

use std::io::Write as _;
use std::process::ExitCode;

use anyhow::bail;

use crate::arguments::TermOptions;
use crate::show::Shown;
use crate::socket::Connection;

pub(crate) fn run(options: &TermOptions) -> anyhow::Result<ExitCode> {
    match (&options.port, &options.socket, &options.robot) {
        (Some(port), ..) => direct::run(port, options),
        (None, Some(socket), _) => relay::run(Connection::open_here(socket)?, options),
        (None, None, Some(robot)) => relay::run(Connection::open_there(robot)?, options),
        (None, None, None) => bail!(
            "name the robot's serial device with --port, vthal's socket with --socket, or a robot on the network with --robot"
        ),
    }
}

/// Prints one packet with time and direction, unless its word is left out.
fn print_packet(time_s: f64, direction: char, shown: &Shown, options: &TermOptions) -> std::io::Result<()> {
    if options.skip.iter().any(|word| shown.has_word(word)) {
        return Ok(());
    }
    writeln!(std::io::stdout(), "{time_s:10.3} {direction} {}", shown.line())
}

/// Prints a remark of this program.
fn print_remark(time_s: f64, remark: &str) -> std::io::Result<()> {
    writeln!(std::io::stdout(), "{time_s:10.3} # {remark}")
}
