//! What benchmarks of whole runs share: sets of homes by name, work over threads, medians and percentiles.

mod crew;
mod named_home;
mod spread;

pub use crew::in_order;
pub use named_home::NamedHome;
pub use spread::{Better, RunFigure, Spread};
