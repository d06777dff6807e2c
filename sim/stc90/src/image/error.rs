//! Why a file is no program for this part: what, where, and what to do about it.

use crate::PART;

/// Why a text is no image for this part.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// Bytes that this part has no program flash for.
    #[error(
        "line {line} of the HEX file: {length} bytes at {address:#06x} are outside of the program flash of the {PART} \
         (0000..8000): link the program with --code-size 32768"
    )]
    OutsideFlash {
        /// Line, from 1.
        line: usize,
        /// Address of the first byte, as the file has it.
        address: u32,
        /// How many bytes.
        length: usize,
    },
    /// There is nothing to program.
    #[error("the file has nothing to program into flash")]
    Empty,
    /// The text is no Intel HEX.
    #[error("line {line} of the HEX file: {fault}")]
    Hex {
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        fault: HexFault,
    },
}

/// What is wrong with a line of Intel HEX.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HexFault {
    /// It does not begin with a colon.
    #[error("it does not begin with a colon")]
    NoColon,
    /// There is a character that is no hexadecimal digit, or an odd number of them.
    #[error("it does not consist of pairs of hexadecimal digits")]
    NoHex,
    /// The number of bytes is not the one that it names.
    #[error("it says {says} bytes of data and has {has}")]
    Length {
        /// By its first byte.
        says: usize,
        /// In the line.
        has: usize,
    },
    /// Its bytes do not sum up to zero.
    #[error("its checksum is wrong: the file was damaged, copy or build it again")]
    Checksum,
    /// A record type that is not 0, 1, 2, 3, 4 or 5.
    #[error("record type {0} is unknown")]
    Record(u8),
    /// The file goes on after its end record.
    #[error("it comes after the end record")]
    AfterEnd,
    /// There is no end record.
    #[error("the file ends without an end record: it was cut off, copy or build it again")]
    NoEnd,
}
