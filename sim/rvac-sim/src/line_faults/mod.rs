//! Faults of the line between robot and host, one at a time and under control: how far the robot cleans through each, what
//! it says meanwhile, and how soon it goes on afterwards.
//!
//! [`crate::faults`] damages bits at random under the safety monitor. Here whole packets are changed, so that each fault
//! has one cause: a seal that is wrong, a clock that jumps, a report that comes twice.

mod fault;
mod packets;
mod table;
mod tamper;
mod trial;

pub use fault::{HostClock, LineFault};
pub use table::LineFaultTable;
pub use tamper::Tamper;
pub use trial::{FaultPassage, LineTrial, passages};
