//! What can go wrong, and what to do then.

use crate::flasher::Step;
use crate::model::Model;

/// Why nothing, or not all, was written. The loader itself is in memory that nobody can write: it is always there again after a power
/// cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IspError {
    /// Nobody answers the call.
    #[error(
        "the chip's loader does not answer. Check that its supply goes really off (the Linux board may feed it through a data line), \
         that RX and TX are not swapped, and that the line is at 5 V"
    )]
    NoLoader,
    /// The status is too short or its clock impossible.
    #[error("what answers is no loader of an STC89 or STC90: the status makes no sense. Nothing was touched")]
    NotUnderstood,
    /// Another chip.
    #[error("this is {}, not an STC90C58RD+; nothing was touched", found(*.0))]
    WrongModel(u16),
    /// No rate works.
    #[error(
        "the line works at 2400 baud but at no faster rate. Check ground and level shifter. Nothing was touched"
    )]
    NoRate,
    /// The image does not fit.
    #[error("the program has {0} bytes, and the chip takes 1 to 32768. Nothing was touched")]
    ImageSize(usize),
    /// The chip falls silent, or answers something else, again and again.
    #[error(
        "the chip does not answer as it must while the host does this: {step:?} ({attempts} times). What was written is not whole: \
         try again, with the robot switched off and on"
    )]
    Silent {
        /// During which step.
        step: Step,
        /// How often it was tried.
        attempts: u32,
    },
    /// The sum of a block differs.
    #[error(
        "the chip confirms another sum at {address:#06x} ({attempts} times): the line or the flash is bad. Try again"
    )]
    BlockSum {
        /// Start of the block.
        address: usize,
        /// How often it was tried.
        attempts: u32,
    },
}

fn found(id: u16) -> String {
    match Model::of_id(id) {
        Some(model) => format!("an {}", model.name),
        None => format!("a chip with the unknown identity {id:#06x}"),
    }
}
