//! The log: numbered lines, the newest of which are kept for clients that come later.

use rvac_api::{LogEntry, LogLevel};

use crate::newest::Newest;
use crate::to_api;

/// Lines kept.
const KEPT: usize = 200;

/// Part of the software that wrote an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LogSource {
    /// The daemon.
    Vthal,
    /// The brain.
    Brain,
    /// The robot's firmware.
    Firmware,
    /// The link to it.
    Link,
    /// A client.
    Client,
}

impl LogSource {
    fn name(self) -> &'static str {
        match self {
            Self::Vthal => "vthal",
            Self::Brain => "brain",
            Self::Firmware => "firmware",
            Self::Link => "link",
            Self::Client => "client",
        }
    }
}

/// The newest lines.
#[derive(Debug, Default)]
pub(crate) struct Journal {
    newest: Newest<LogEntry, KEPT>,
}

impl Journal {
    /// Numbers a line and keeps it.
    pub(crate) fn write(
        &mut self,
        now_us: u64,
        level: LogLevel,
        (part, text): (LogSource, String),
    ) -> LogEntry {
        self.newest.keep(|number| LogEntry {
            number,
            t: to_api::seconds(now_us),
            level,
            part: part.name().to_owned(),
            text,
        })
    }

    /// The lines that are kept, oldest first.
    pub(crate) fn entries(&self) -> impl Iterator<Item = &LogEntry> {
        self.newest.entries()
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::LogLevel;

    use super::{Journal, KEPT, LogSource};

    #[test]
    fn the_newest_lines_are_kept_and_numbers_go_on() {
        let mut journal = Journal::default();
        for line in 0..KEPT + 5 {
            journal.write(0, LogLevel::Info, (LogSource::Vthal, line.to_string()));
        }
        let numbers: Vec<u64> = journal.entries().map(|entry| entry.number).collect();
        assert_eq!(numbers.len(), KEPT);
        assert_eq!((numbers[0], numbers[KEPT - 1]), (6, KEPT as u64 + 5));
    }
}
