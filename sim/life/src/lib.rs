//! A robot's life in one home: run after run, each daemon with what the one before left on its disk.
//!
//! A [`Chain`] is one robot in one home. Each run starts on the dock with other noise; the daemon's core is restarted from the
//! files that the daemon's own store has written ([`vthal::KeptStore`]). [`LifeTable`] has the medians over chains of each run.
#![forbid(unsafe_code)]

mod chain;
mod changes;
mod run;
mod table;
mod wear;

pub use chain::{Chain, ChainSettings, LivedHome};
pub use changes::{ChangingHome, HomeChange};
pub use run::{LifeRun, LifeTiming};
pub use table::LifeTable;
pub use wear::Wear;
