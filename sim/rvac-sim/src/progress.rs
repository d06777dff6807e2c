//! One line of progress on a terminal.

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicU32, Ordering};

/// A line that is rewritten in place; silent where standard error is not a terminal.
#[derive(Debug)]
pub(crate) struct Progress {
    what: &'static str,
    shown_permille: AtomicU32,
    terminal: bool,
}

impl Progress {
    pub(crate) fn new(what: &'static str) -> Self {
        Self {
            what,
            shown_permille: AtomicU32::new(u32::MAX),
            terminal: io::stderr().is_terminal(),
        }
    }

    /// Shows a share of 0 to 1, if it differs visibly.
    pub(crate) fn show(&self, share: f64) {
        let permille = (share * 1000.0) as u32;
        if self.terminal && self.shown_permille.swap(permille, Ordering::Relaxed) != permille {
            // A failure to show progress does not stop the run.
            write!(io::stderr(), "\r{} {:5.1} %", self.what, share * 100.0).ok();
        }
    }

    /// Takes the line away.
    pub(crate) fn clear(&self) {
        if self.terminal {
            // As above.
            write!(io::stderr(), "\r\x1b[K").ok();
        }
    }
}
