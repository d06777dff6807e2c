//! Why a file is no program for this part: what, where, and what to do about it.

use super::PART;
use std::fmt;

/// Why bytes are no image for this part.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The first bytes are not those of an ELF.
    #[error("this is no ELF file: its first bytes are not 7f 45 4c 46; name the ELF that the linker wrote")]
    NotElf,
    /// The file ends before something that it promises.
    #[error(
        "the ELF file ends at byte {length}, but its {part} ends at byte {needed}: copy or build it again"
    )]
    Truncated {
        /// What lies outside.
        part: ElfPart,
        /// Where it would end.
        needed: u64,
        /// Bytes of the file.
        length: usize,
    },
    /// A 64-bit ELF.
    #[error("the ELF file is for a 64-bit machine (class {0}); build for the target mipsel-unknown-none")]
    WrongClass(u8),
    /// A big-endian ELF.
    #[error("the ELF file is not little endian (data encoding {0}); build for mipsel, not mips")]
    WrongEndianness(u8),
    /// An ELF for another processor.
    #[error(
        "the ELF file is for another processor (machine {0}, MIPS is 8); build for the target mipsel-unknown-none"
    )]
    WrongMachine(u16),
    /// An ELF that is not linked to fixed addresses.
    #[error(
        "the ELF file is no linked program (type {0}, 2 is wanted); name the linker's output, not an object or library"
    )]
    NotLinked(u16),
    /// An ELF for a MIPS that this core is not.
    #[error(
        "the ELF file is for another MIPS architecture (flags {flags:#010x}); compile for mips32 or mips32r2, \
         without micromips and MIPS16e"
    )]
    WrongArchitecture {
        /// The field `e_flags`.
        flags: u32,
    },
    /// An ELF that says which part it is for.
    #[error("the program was made for the part {0}, this is a {PART}: link it for this part")]
    WrongPart(String),
    /// A header whose entries have another size than the format says.
    #[error("the ELF file has {part} entries of {found} bytes instead of {wanted}: it is damaged")]
    EntrySize {
        /// Which table.
        part: ElfPart,
        /// Bytes of an entry by the file.
        found: u16,
        /// Bytes of an entry by the format.
        wanted: u16,
    },
    /// Bytes that this part has no flash for.
    #[error(
        "{length} bytes at {address:#010x} are outside of the flash of the {PART} (program flash 1d000000..1d040000, \
         boot flash 1fc00000..1fc03000, or the same in KSEG0 and KSEG1): link it for this part"
    )]
    OutsideFlash {
        /// Address of the first byte, as the file has it.
        address: u32,
        /// How many bytes.
        length: usize,
    },
    /// Variables that this part has no memory for.
    #[error(
        "{length} bytes at {address:#010x} are in no memory of the {PART} (RAM 80000000..80008000): link it for this part"
    )]
    OutsideRam {
        /// Virtual address of the first byte.
        address: u32,
        /// How many bytes.
        length: u32,
    },
    /// A stack that this part has no memory for.
    #[error(
        "the program's stack begins at {address:#010x} (symbol {symbol}), but the RAM of the {PART} ends at 80008000: \
         it was linked for another part, link it for this one"
    )]
    StackOutside {
        /// The symbol that says so.
        symbol: String,
        /// The stack pointer that the program begins with.
        address: u32,
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

/// A part of an ELF file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElfPart {
    /// The header.
    Header,
    /// The table of segments.
    ProgramHeaders,
    /// The segment with this number, from 0.
    Segment(u16),
    /// The table of sections.
    SectionHeaders,
    /// The section with this number, from 0.
    Section(u16),
}

impl fmt::Display for ElfPart {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Header => formatter.write_str("header"),
            Self::ProgramHeaders => formatter.write_str("table of segments"),
            Self::Segment(number) => write!(formatter, "segment {number}"),
            Self::SectionHeaders => formatter.write_str("table of sections"),
            Self::Section(number) => write!(formatter, "section {number}"),
        }
    }
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
