//! The world around a daemon under test: a robot at the far end of a pseudo terminal, clients, and the process itself.
#![forbid(unsafe_code)]

mod client;
mod delays;
mod hostile;
mod kept_home;
mod living;
pub mod nonsense;
mod process;
mod pty;
mod random;
mod robot;
mod usage;

pub use client::Client;
pub use delays::Delays;
pub use hostile::{HostileKind, Siege, SiegeEnd, estimate};
pub use kept_home::keep_home;
pub use living::LivingRobot;
pub use process::{Daemon, Scratch, built_beside, needed_beside};
pub use pty::Pty;
pub use random::next_random;
pub use robot::SyntheticRobot;
pub use usage::{Processor, resident_max_mib, resident_mib};
