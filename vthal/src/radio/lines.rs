//! Bytes into lines.

use super::reading::LineError;

/// Longest line, bytes: four anchors of a DWM1001 take 150.
pub(super) const LINE_MAX: usize = 512;

/// Collects bytes until a line is over.
#[derive(Debug)]
pub(super) struct Lines {
    line: Vec<u8>,
    state: FramingState,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FramingState {
    /// The device was just opened: what comes may be the rest of a line.
    Joining,
    Reading,
    /// The line is too long; its end is waited for.
    Skipping,
}

impl Default for Lines {
    fn default() -> Self {
        Self {
            line: Vec::with_capacity(LINE_MAX),
            state: FramingState::Joining,
        }
    }
}

impl Lines {
    /// Hands each line that is over now to `take`: its bytes without the end, or why they are no line.
    pub(super) fn split(&mut self, bytes: &[u8], mut take: impl FnMut(Result<&[u8], LineError>)) {
        for &byte in bytes {
            if matches!(byte, b'\n' | b'\r') {
                if self.state == FramingState::Reading && !self.line.is_empty() {
                    take(Ok(&self.line));
                }
                self.line.clear();
                self.state = FramingState::Reading;
            } else if self.state == FramingState::Reading {
                if self.line.len() < LINE_MAX {
                    self.line.push(byte);
                } else {
                    self.state = FramingState::Skipping;
                    take(Err(LineError::TooLong(LINE_MAX)));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LINE_MAX, Lines};

    fn split(pieces: &[&[u8]]) -> Vec<Option<Vec<u8>>> {
        let mut lines = Lines::default();
        let mut all = Vec::new();
        for piece in pieces {
            lines.split(piece, |line| all.push(line.ok().map(<[u8]>::to_vec)));
        }
        all
    }

    #[test]
    fn lines_come_in_any_pieces_and_the_first_may_be_the_rest_of_one() {
        let some = |text: &str| Some(text.as_bytes().to_vec());
        assert_eq!(
            split(&[b"rest\na", b"b\r\n\r\n", b"c\nd"]),
            [some("ab"), some("c")]
        );
    }

    #[test]
    fn a_line_without_end_takes_no_more_memory_and_is_reported_once() {
        let flood = vec![b'x'; 4 * LINE_MAX];
        assert_eq!(
            split(&[b"\n", &flood, &flood, b"\nok\n"]),
            [None, Some(b"ok".to_vec())]
        );
    }
}
