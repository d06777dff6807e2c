//! `rvac doctor`: a line for each thing that was looked at, with cause and remedy. This is what a report of a fault should bring.

use std::io::{Write as _, stdout};
use std::path::Path;
use std::process::ExitCode;
use std::time::{SystemTime, UNIX_EPOCH};

use super::answering;
use crate::arguments::{Console, Daemon, DoctorOptions};
use crate::board::{self, Board, Finding, Grade};

/// Prints all findings; fails when the robot cannot work.
pub(crate) fn run(options: &DoctorOptions) -> anyhow::Result<ExitCode> {
    let findings = findings(&Board::below(Path::new("/")), &options.daemon, &options.console);
    if options.json {
        writeln!(stdout(), "{}", serde_json::to_string_pretty(&findings)?)?;
    } else {
        print(&findings)?;
    }
    let is_well = findings.iter().all(|finding| finding.grade != Grade::Fault);
    Ok(if is_well {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// Everything that can be found out.
pub(super) fn findings(board: &Board, daemon: &Daemon, console: &Console) -> Vec<Finding> {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    let mut findings = board::all(board, since.map_or(0, |since| since.as_secs()));
    findings.extend(answering::all(daemon, console));
    findings
}

/// A line for each.
pub(super) fn print(findings: &[Finding]) -> std::io::Result<()> {
    let mut out = stdout().lock();
    findings
        .iter()
        .try_for_each(|finding| writeln!(out, "{}", finding.line()))
}
