//! What can go wrong, and what to do then.

use crate::image::ConfigurationRisk;
use crate::pins::LineLevel;

/// Why something was not done. Nothing is lost by any of these: programming mode does not need what is in the flash.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IcspError<E> {
    /// A line of the host.
    #[error("the Linux board cannot use its lines: {0}")]
    Pins(E),
    /// Identity and status read all ones or all zeros.
    #[error(
        "no chip answers: the data line always reads {}. Check ground, that the robot's board has power, that reset \
         reaches pin 13, and that PGC2 (pin 26) and PGD2 (pin 27) are not swapped", word(*.0)
    )]
    NoAnswer(LineLevel),
    /// Answers differ from each other.
    #[error(
        "the chip's answers differ from try to try ({first:#010x}, then {second:#010x}). Shorten the wires, put 100 to 470 ohm \
         into clock and data, or choose a slower clock"
    )]
    Unsteady {
        /// What was read first.
        first: u32,
        /// And then.
        second: u32,
    },
    /// Another part, or none.
    #[error("this is {}, not a PIC32MX360F256L; nothing was touched", found(*.0))]
    WrongPart(u32),
    /// The part says that it may not be read.
    #[error(
        "the chip is code-protected: its firmware cannot be read, and only an erasure of the whole chip lets another in. Nothing \
         was touched"
    )]
    CodeProtected,
    /// The status does not become what it must.
    #[error(
        "the chip does not get ready (status {0:#04x}). Switch the robot's board off and on, then try again"
    )]
    NotReady(u8),
    /// The core does not ask for instructions.
    #[error(
        "the chip's core does not come up for the programmer. Switch the robot's board off and on, then try again"
    )]
    CoreSilent,
    /// The program in RAM is not what was sent, or does not go on.
    #[error(
        "the line to the chip lost or changed something near {address:#010x}, {attempts} times in a row. Shorten the wires or \
         choose a slower clock, then start again: nothing is lost"
    )]
    LineFaulty {
        /// Where.
        address: u32,
        /// How often it was tried.
        attempts: u32,
    },
    /// The flash controller reports an error.
    #[error(
        "the chip's flash refuses at {address:#010x} (NVMCON {control:#06x}). If pages are write-protected, erase the whole chip \
         first; otherwise check the supply"
    )]
    FlashRefused {
        /// Page or row.
        address: u32,
        /// Its control register.
        control: u32,
    },
    /// What is in the chip differs from the image.
    #[error("the chip holds {found:#010x} at {address:#010x} in place of {wanted:#010x}. Write again")]
    Differs {
        /// Where.
        address: u32,
        /// What the image has.
        wanted: u32,
        /// What the chip has.
        found: u32,
    },
    /// The image would make the chip hard to reach.
    #[error("refused: the image's configuration words would {0}")]
    Configuration(ConfigurationRisk),
}

fn word(level: LineLevel) -> &'static str {
    match level {
        LineLevel::Low => "low",
        LineLevel::High => "high",
    }
}

fn found(id: u32) -> String {
    match crate::part::Part::of_id(id) {
        Some(part) => format!("a {}", part.name),
        None => format!("an unknown part ({id:#010x})"),
    }
}
