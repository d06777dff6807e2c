//! What a robot decided and why, for people who want to know why it stands where it does.

use std::io::{self, Write};

use rvac_api::LogEntry;

/// Writes a log, an entry a line: seconds since the host's start, the part that speaks, and what it says.
///
/// # Errors
/// When `out` takes nothing.
pub fn explain(log: &[LogEntry], out: &mut impl Write) -> io::Result<()> {
    log.iter()
        .try_for_each(|entry| writeln!(out, "{:>8.1} {:8} {}", entry.t, entry.part, entry.text))
}
