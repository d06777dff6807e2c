//! A faulty serial line: 8N1 bit by bit, with faults drawn from a seed.
//!
//! [`Channel`] wraps any stream of bytes: what is put in comes out as the receiver's hardware would report it, damaged as
//! [`FaultRates`] say. The same seed and the same calls give the same damage. The line knows bytes, not packets; faults that
//! need packets (splices, echoes, packets of an earlier session) are made by whoever knows them, such as the benchmark.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod channel;
mod random;
mod robot;
mod uart;

pub use channel::{Channel, FaultRates};
pub use random::Pcg32;
pub use robot::switched_on;
pub use uart::{ReceivedByte, UartReceiver};
