//! Thousands of charges: the real charger of cordlib on simulated packs, converters, contacts and supplies, without the
//! rest of a robot.
//!
//! A charge is drawn from its seed ([`Conditions`]), run to its end and half an hour beyond ([`ChargeBench`]), and
//! judged by the true state of the pack ([`ChargeOutcome`]). The charger is called once an envelope of its switch,
//! every 20 ms, with the mean of four conversions each time: a real board has up to twenty. The pack's chemistry and
//! heat are advanced once a second; the voltage follows the current at once.

mod bench;
mod conditions;
mod converter;
mod outcome;
mod tally;

pub use bench::ChargeBench;
pub use conditions::{Conditions, InjectedFault};
pub use outcome::{ChargeOutcome, run};
pub use tally::{ChargeTally, ChargeTrial};
