//! Log lines that wait for the link. Lines are made of fixed words, so that a ring of them costs little memory.

use heapless::Deque;
use rvac_protocol::message::{LogLevel, LogText};

/// Lines that can wait; the oldest gives way.
const LINES: usize = 8;

/// One line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LogLine {
    pub(crate) level: LogLevel,
    pub(crate) what: &'static str,
    pub(crate) which: &'static str,
}

/// The ring.
#[derive(Clone, Debug, Default)]
pub(crate) struct Journal {
    lines: Deque<LogLine, LINES>,
    lost: u32,
}

impl Journal {
    /// Notes a line.
    pub(crate) fn note(&mut self, level: LogLevel, what: &'static str, which: &'static str) {
        if self.lines.is_full() {
            self.lines.pop_front();
            self.lost = self.lost.saturating_add(1);
        }
        // Never full here: room was made just now.
        self.lines.push_back(LogLine { level, what, which }).ok();
    }

    /// The oldest line, with the number of lines that were lost before it.
    pub(crate) fn take(&mut self) -> Option<(LogLevel, LogText)> {
        let line = self.lines.pop_front()?;
        let mut text = LogText::new();
        // Words of this crate are far shorter than a line; a board's long line is cut.
        write_cut(&mut text, line.what);
        if !line.which.is_empty() {
            write_cut(&mut text, " ");
            write_cut(&mut text, line.which);
        }
        if self.lost > 0 {
            write_cut(&mut text, ", lines before it lost: ");
            write_count(&mut text, self.lost);
            self.lost = 0;
        }
        Some((line.level, text))
    }
}

fn write_cut(text: &mut LogText, words: &str) {
    for letter in words.chars() {
        if text.push(letter).is_err() {
            return;
        }
    }
}

/// Digits by hand: the formatting machinery of the language would cost kilobytes of flash.
fn write_count(text: &mut LogText, count: u32) {
    let mut scale = 1_000_000_000;
    while scale > 1 && count < scale {
        scale /= 10;
    }
    while scale > 0 {
        let digit = char::from_digit(count / scale % 10, 10).unwrap_or('?');
        // A full line loses its last digits, like every long line.
        text.push(digit).ok();
        scale /= 10;
    }
}

#[cfg(test)]
mod tests {
    use super::Journal;
    use rvac_protocol::message::LogLevel;

    #[test]
    fn the_oldest_line_gives_way_and_is_counted() {
        let mut journal = Journal::default();
        for _ in 0..9 {
            journal.note(LogLevel::Info, "inhibit", "bumper");
        }
        let (_, first) = journal.take().unwrap();
        assert_eq!(first.as_str(), "inhibit bumper, lines before it lost: 1");
        assert_eq!(journal.take().unwrap().1.as_str(), "inhibit bumper");
    }

    #[test]
    fn counts_are_spelt_in_full() {
        for (count, digits) in [(0, "0"), (7, "7"), (10, "10"), (u32::MAX, "4294967295")] {
            let mut text = super::LogText::new();
            super::write_count(&mut text, count);
            assert_eq!(text.as_str(), digits);
        }
    }

    #[test]
    fn a_long_line_is_cut() {
        let mut journal = Journal::default();
        const LONG: &str = "0123456789012345678901234567890123456789012345678901234567890123456789\
                            0123456789012345678901234567890123456789012345678901234567890123456789";
        journal.note(LogLevel::Info, LONG, "tail");
        assert_eq!(journal.take().unwrap().1.len(), 120);
    }
}
