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

/// The same line about a client is written again after this time; until then it is counted. So many different ones are watched, and
/// all others together are one more.
const COUNTED_US: u64 = 5_000_000;
const COUNTED_MAX: usize = 32;
const OTHERS: &str = "more was asked by clients than is told one by one";

/// The newest lines.
#[derive(Debug, Default)]
pub(crate) struct Journal {
    newest: Newest<LogEntry, KEPT>,
    /// Lines about clients of the last seconds.
    counted: Vec<CountedLine>,
}

/// A line that was written, and how often it would have been since.
#[derive(Debug)]
struct CountedLine {
    at_us: u64,
    level: LogLevel,
    text: String,
    times: u32,
}

impl Journal {
    /// Numbers a line and keeps it. Gives what is new in the log: how often lines about clients came meanwhile, and this one, unless
    /// it is only counted. Somebody who sends the same thing thousands of times must not drive everything else out of the log.
    pub(crate) fn write(
        &mut self,
        now_us: u64,
        level: LogLevel,
        (part, text): (LogSource, String),
    ) -> Vec<LogEntry> {
        let is_over = |line: &mut CountedLine| now_us.saturating_sub(line.at_us) >= COUNTED_US;
        let over: Vec<CountedLine> = self.counted.extract_if(.., is_over).collect();
        let mut entries = Vec::new();
        for line in over.into_iter().filter(|line| line.times > 0) {
            let text = format!("{} ({} times more)", line.text, line.times);
            entries.push(self.keep(now_us, line.level, (LogSource::Client, text)));
        }
        let mut text = text;
        if part == LogSource::Client {
            let is_watched = self.counted.iter().any(|line| line.text == text);
            if !is_watched && self.counted.len() >= COUNTED_MAX {
                text = OTHERS.to_owned();
            }
            if let Some(line) = self.counted.iter_mut().find(|line| line.text == text) {
                line.times = line.times.saturating_add(1);
                return entries;
            }
            self.counted.push(CountedLine {
                at_us: now_us,
                level,
                text: text.clone(),
                times: 0,
            });
        }
        entries.push(self.keep(now_us, level, (part, text)));
        entries
    }

    fn keep(&mut self, now_us: u64, level: LogLevel, (part, text): (LogSource, String)) -> LogEntry {
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

    use super::{COUNTED_MAX, Journal, KEPT, LogSource, OTHERS};

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

    #[test]
    fn what_many_clients_do_without_end_is_counted_too() {
        let mut journal = Journal::default();
        let mut lines = 0;
        for at_us in 0..100_000_u64 {
            let text = format!("stopped by client {}", at_us % 100);
            lines += journal
                .write(10 * at_us, LogLevel::Info, (LogSource::Client, text))
                .len();
        }
        assert_eq!(lines, COUNTED_MAX + 1, "in one second");
        let after = journal.write(6_000_000, LogLevel::Info, (LogSource::Vthal, "rests".to_owned()));
        assert_eq!(after.len(), COUNTED_MAX + 2, "how often each came, and this one");
        assert!(after.iter().any(|entry| entry.text.starts_with(OTHERS)));
    }

    #[test]
    fn what_a_client_does_without_end_is_counted() {
        let mut journal = Journal::default();
        journal.write(0, LogLevel::Info, (LogSource::Vthal, "begins".to_owned()));
        for at_us in 0..9_000 {
            journal.write(
                100 * at_us,
                LogLevel::Info,
                (LogSource::Client, "stopped by anna".to_owned()),
            );
        }
        journal.write(6_000_000, LogLevel::Warn, (LogSource::Brain, "slips".to_owned()));
        let texts: Vec<&str> = journal.entries().map(|entry| entry.text.as_str()).collect();
        let expected = [
            "begins",
            "stopped by anna",
            "stopped by anna (8999 times more)",
            "slips",
        ];
        assert_eq!(texts, expected);
    }
}
