//! Bytes that a serial port received with a framing or parity error, or a break: the kernel marks them in what it hands over.
//!
//! How often a port has met such errors is a count of the kernel that only an ioctl without a safe interface reads. Marks
//! (`PARMRK` with `INPCK`, termios(3)) come with the bytes instead: 0xFF 0x00 X stands for X with an error, 0xFF 0xFF for a sound 0xFF.

use std::io;
use std::os::fd::AsFd;

use rustix::termios::{InputModes, OptionalActions, tcgetattr, tcsetattr};

/// Before a byte with an error, and before itself.
const ESCAPE: u8 = 0xFF;
/// Behind the escape: the byte behind this has an error.
const FAULTY: u8 = 0x00;

/// Lets the kernel mark the bytes of this line, which is in raw mode, from now on.
pub(crate) fn mark_errors(line: impl AsFd) -> io::Result<()> {
    let mut settings = tcgetattr(&line)?;
    settings
        .input_modes
        .remove(InputModes::IGNPAR | InputModes::IGNBRK | InputModes::BRKINT | InputModes::ISTRIP);
    settings
        .input_modes
        .insert(InputModes::PARMRK | InputModes::INPCK);
    tcsetattr(line, OptionalActions::Now, &settings)?;
    Ok(())
}

/// Takes the marks out of what the kernel hands over, in pieces of any size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct LineMarks {
    expects: Expects,
}

/// What the next byte is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Expects {
    #[default]
    Byte,
    BehindEscape,
    FaultyByte,
}

/// A piece without its marks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Unmarked {
    /// What came, bytes with errors included.
    pub bytes: Vec<u8>,
    /// So many of them had an error.
    pub errors: u32,
}

impl LineMarks {
    /// Takes the marks out of the next piece.
    pub(crate) fn take_out(&mut self, marked: &[u8]) -> Unmarked {
        let mut unmarked = Unmarked::default();
        unmarked.bytes.reserve(marked.len());
        for &byte in marked {
            self.expects = match (self.expects, byte) {
                (Expects::Byte, ESCAPE) => Expects::BehindEscape,
                (Expects::BehindEscape, FAULTY) => Expects::FaultyByte,
                (Expects::BehindEscape, other) if other != ESCAPE => {
                    // The kernel never does this; what it is is for the decoder of packets to find out.
                    unmarked.bytes.extend([ESCAPE, other]);
                    Expects::Byte
                }
                (expected, byte) => {
                    unmarked.errors += u32::from(expected == Expects::FaultyByte);
                    unmarked.bytes.push(byte);
                    Expects::Byte
                }
            };
        }
        unmarked
    }
}

#[cfg(test)]
mod tests {
    use super::{LineMarks, Unmarked, mark_errors};
    use crate::serial::{SerialSettings, open};
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use std::io::Write;
    use std::path::PathBuf;

    /// What the kernel hands over for these bytes and errors.
    const MARKED: &[u8] = &[
        0x31, 0xFF, 0xFF, 0xFF, 0x00, 0xFF, 0xFF, 0x00, 0x00, 0x00, 0xFF, 0x00, 0x41, 0x42,
    ];

    #[test]
    fn marks_are_taken_out_and_counted_wherever_a_piece_ends() {
        let whole = Unmarked {
            bytes: vec![0x31, 0xFF, 0xFF, 0x00, 0x00, 0x41, 0x42],
            errors: 3,
        };
        assert_eq!(LineMarks::default().take_out(MARKED), whole);
        for cut in 0..MARKED.len() {
            let mut marks = LineMarks::default();
            let (first, second) = (marks.take_out(&MARKED[..cut]), marks.take_out(&MARKED[cut..]));
            let joined = [first.bytes, second.bytes].concat();
            assert_eq!(
                (joined, first.errors + second.errors),
                (whole.bytes.clone(), whole.errors),
                "{cut}"
            );
        }
    }

    #[test]
    fn what_the_kernel_never_hands_over_is_kept_as_it_is() {
        let mut marks = LineMarks::default();
        let unmarked = marks.take_out(&[0xFF, 0x41, 0xFF]);
        assert_eq!(
            (unmarked.bytes.as_slice(), unmarked.errors),
            ([0xFF, 0x41].as_slice(), 0)
        );
        assert_eq!(marks.take_out(&[0xFF]).bytes, [0xFF]);
    }

    /// A pseudo terminal has no framing, but its line discipline is the one that marks: each 0xFF comes twice, and is one again.
    #[tokio::test]
    async fn every_byte_passes_a_line_that_marks() {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&master).unwrap();
        unlockpt(&master).unwrap();
        let path = PathBuf::from(ptsname(&master, Vec::new()).unwrap().into_string().unwrap());
        let line = open(&SerialSettings { path, baud: 115_200 }).unwrap();
        mark_errors(&line.lock).unwrap();
        let all: Vec<u8> = (0..=u8::MAX).chain([0xFF, 0xFF, 0x00, 0x41]).collect();
        std::fs::File::from(master.try_clone().unwrap())
            .write_all(&all)
            .unwrap();
        let mut marks = LineMarks::default();
        let (mut came, mut handed_over) = (Unmarked::default(), 0);
        let mut buffer = [0; 64];
        while came.bytes.len() < all.len() {
            let count = line.port.read(&mut buffer).await.unwrap();
            handed_over += count;
            let piece = marks.take_out(&buffer[..count]);
            came.bytes.extend(piece.bytes);
            came.errors += piece.errors;
        }
        assert_eq!((came.bytes, came.errors), (all.clone(), 0));
        assert_eq!(handed_over, all.len() + 3, "the kernel marks");
    }
}
