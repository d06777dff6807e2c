//! The log: numbered lines, the newest of which are kept for clients that come later.

use std::collections::VecDeque;

use rvac_api::{LogEntry, LogLevel};

/// Lines kept.
const KEPT: usize = 200;

/// Part that speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
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

impl Part {
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
    entries: VecDeque<LogEntry>,
    written: u64,
}

impl Journal {
    /// Numbers a line and keeps it.
    pub(crate) fn write(&mut self, now_us: u64, level: LogLevel, (part, text): (Part, String)) -> LogEntry {
        self.written += 1;
        let entry = LogEntry {
            number: self.written,
            t: now_us as f64 / 1e6,
            level,
            part: part.name().to_owned(),
            text,
        };
        if self.entries.len() == KEPT {
            self.entries.pop_front();
        }
        self.entries.push_back(entry.clone());
        entry
    }

    /// The lines that are kept, oldest first.
    pub(crate) fn entries(&self) -> impl Iterator<Item = &LogEntry> {
        self.entries.iter()
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::LogLevel;

    use super::{Journal, KEPT, Part};

    #[test]
    fn the_newest_lines_are_kept_and_numbers_go_on() {
        let mut journal = Journal::default();
        for line in 0..KEPT + 5 {
            journal.write(0, LogLevel::Info, (Part::Vthal, line.to_string()));
        }
        let numbers: Vec<u64> = journal.entries().map(|entry| entry.number).collect();
        assert_eq!(numbers.len(), KEPT);
        assert_eq!((numbers[0], numbers[KEPT - 1]), (6, KEPT as u64 + 5));
    }
}
