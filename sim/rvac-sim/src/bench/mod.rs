//! What benchmarks of whole runs share: sets of homes by name, work over threads, medians and percentiles.

mod crew;
mod named_home;
mod spread;

pub use crew::in_order;
pub use named_home::NamedHome;
pub use spread::{Better, RunFigure, Spread};

/// The battery is filled up so often, milliseconds: what energy allows is another measurement.
pub const REFILL_MS: u64 = 300_000;
/// Longest job that the host allows itself, seconds: what a job takes is measured, not cut off.
pub const BUDGET_S: u32 = 86_400;
