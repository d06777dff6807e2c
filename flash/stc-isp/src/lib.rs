//! Writes an STC89C/STC90C through the boot loader that is in the chip, over its serial line.
//!
//! [`Flasher`] is the protocol without I/O: bytes and the time go in, [`Action`]s come out (bytes to send, a rate to set, power to
//! switch), and it says when it wants to be called next. The loader cannot read flash out, so each block is verified by the sum that
//! the chip answers, and a backup of the maker's firmware does not exist.
//!
//! The option that hides the loader unless P1.0 and P1.1 are low can never be written: [`OptionByte`] has no way to clear it. On the
//! robot these pins are sensors, and such a chip would be closed for ever.
//!
//! Not spoken: the dialect of newer chips with parity and sums of 16 bits, which stcgal calls `stc89a`.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod clock;
mod flasher;
mod frame;
mod model;
mod options;

pub use clock::{ChipClock, HANDSHAKE_BAUD, RATES_BAUD};
pub use flasher::{Action, Entry, Flasher, IspError, Job, Report, Step};
pub use model::Model;
pub use options::OptionByte;
