//! The log as the panel keeps and searches it.

use std::collections::VecDeque;

use rvac_api::{LogEntry, LogLevel};

use crate::codes::log_text;
use crate::words::Words;

/// Entries that are kept; older ones are in the daemon's files.
const KEPT: usize = 2000;

/// Which entries are shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogFilter {
    /// This grave or graver.
    pub level_min: LogLevel,
    /// In the part or the text, in any case; empty finds all.
    pub search: String,
}

impl Default for LogFilter {
    fn default() -> Self {
        Self {
            level_min: LogLevel::Info,
            search: String::new(),
        }
    }
}

/// The newest entries, each once.
#[derive(Clone, Debug, Default)]
pub struct LogBook {
    entries: VecDeque<LogEntry>,
}

impl LogBook {
    /// Takes an entry. One with a number that is known already is a repetition after a reconnect.
    pub fn push(&mut self, entry: LogEntry) {
        if self
            .entries
            .back()
            .is_some_and(|last| entry.number <= last.number)
        {
            let restarted = self
                .entries
                .back()
                .is_some_and(|last| entry.t + 1.0 < last.t && entry.number <= 1);
            if !restarted {
                return;
            }
            self.entries.clear();
        }
        self.entries.push_back(entry);
        if self.entries.len() > KEPT {
            self.entries.pop_front();
        }
    }

    /// All that is kept, the oldest first.
    pub fn entries(&self) -> impl Iterator<Item = &LogEntry> {
        self.entries.iter()
    }

    /// Forgets everything, for a daemon that starts counting again.
    pub fn clear(&mut self) {
        self.entries.clear();
    }

    /// The newest `most` entries that fit the filter, newest first.
    #[must_use]
    pub fn find(&self, words: &Words, filter: &LogFilter, most: usize) -> Vec<&LogEntry> {
        let wanted = filter.search.trim().to_lowercase();
        let fits = |entry: &&LogEntry| {
            entry.level >= filter.level_min
                && (wanted.is_empty()
                    || entry.text.to_lowercase().contains(&wanted)
                    || log_text(words, entry).0.to_lowercase().contains(&wanted)
                    || entry.part.to_lowercase().contains(&wanted))
        };
        self.entries.iter().rev().filter(fits).take(most).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{KEPT, LogBook, LogFilter};
    use crate::words::Language;
    use rvac_api::{LogEntry, LogLevel};

    fn entry(number: u64, level: LogLevel, text: &str) -> LogEntry {
        LogEntry {
            number,
            t: number as f64,
            level,
            part: "brain".to_owned(),
            text: text.to_owned(),
        }
    }

    fn numbers(book: &LogBook, level_min: LogLevel, search: &str) -> Vec<u64> {
        let filter = LogFilter {
            level_min,
            search: search.to_owned(),
        };
        book.find(Language::English.words(), &filter, 100)
            .iter()
            .map(|entry| entry.number)
            .collect()
    }

    #[test]
    fn filter_by_level_and_text() {
        let mut book = LogBook::default();
        book.push(entry(1, LogLevel::Debug, "tick"));
        book.push(entry(2, LogLevel::Info, "Bump on the left"));
        book.push(entry(3, LogLevel::Error, "wheel blocked"));
        assert_eq!(numbers(&book, LogLevel::Debug, ""), [3, 2, 1]);
        assert_eq!(numbers(&book, LogLevel::Info, "bump "), [2]);
        assert_eq!(numbers(&book, LogLevel::Warn, "BRAIN"), [3]);
        assert!(numbers(&book, LogLevel::Debug, "<b>").is_empty());
    }

    #[test]
    fn repetitions_are_dropped_and_the_oldest_forgotten() {
        let mut book = LogBook::default();
        for number in 1..=KEPT as u64 + 10 {
            book.push(entry(number, LogLevel::Info, "x"));
        }
        book.push(entry(5, LogLevel::Info, "again"));
        assert_eq!(book.entries.len(), KEPT);
        assert_eq!(book.entries.front().unwrap().number, 11);
        book.push(entry(1, LogLevel::Info, "restarted"));
        assert_eq!(book.entries.len(), 1);
    }
}
