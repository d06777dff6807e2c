//! Reads, erases and writes a PIC32MX3xx/4xx over the two wires of its programming port and its reset line.
//!
//! Everything here is a sequence over the trait [`IcspPins`]: no device, no clock of its own, no file. Time comes from the pins,
//! too, so that the same code drives lines of a Linux board and a simulated chip on a virtual clock.
//!
//! [`Programmer`] is the whole: it enters programming mode, refuses a part that it is not for or that is protected *before*
//! anything is touched, puts a program of our own into RAM (`stub/stub.s`, assembled by the build), and with it reads and writes
//! pages. A word that is lost or wrong on the wire is found by sums and repeated from a new entry.
//!
//! Not here: the four-wire port, parts of the MZ and MM families, and the maker's programming executive, which nobody else may
//! pass on.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod debug_core;
mod entry;
mod error;
mod image;
mod part;
mod pins;
mod programmer;
mod stub;
mod test_port;

pub use error::IcspError;
pub use image::{
    BOOT_BYTES, BOOT_START, ConfigurationRisk, FlashImage, PAGE_BYTES, PROGRAM_BYTES, PROGRAM_START,
};
pub use part::Part;
pub use pins::{IcspPins, LineLevel};
pub use programmer::{ErasedFirst, Programmer, Progress, Task};
pub use test_port::TestPort;
