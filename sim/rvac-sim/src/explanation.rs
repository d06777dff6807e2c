//! The robot's decisions and their reasons, for people.

use std::io::{self, Write};

use rvac_api::LogEntry;

/// Writes a log, one entry per line: seconds since the host's start, the part, and its text.
///
/// # Errors
/// When `out` takes nothing.
pub fn explain(log: &[LogEntry], out: &mut impl Write) -> io::Result<()> {
    log.iter()
        .try_for_each(|entry| writeln!(out, "{:>8.1} {:8} {}", entry.t, entry.part, entry.text))
}
