//! The board of the Relax, between the microcontroller's pins and the simulated home.
//!
//! The pins are read from `robots/vileda-relax/pinout.toml`. Over-current lines and the line `battery-ok` never complain:
//! nobody has measured their thresholds. [`EmulatedRelax::hold`] lets them.

mod encoder;
mod error;
mod held;
mod line;
mod motors;
mod pinout;
mod robot;
mod wiring;

pub use error::BoardError;
pub use held::HeldLine;
pub use line::HostRate;
pub use motors::Motor;
pub use robot::{EmulatedRelax, RelaxBlueprint, RelaxSettings};
pub use wiring::{DigitalLine, Wiring};

/// Machine cycles in a second: 30 MHz and six clocks a cycle.
pub const CYCLES_PER_S: u64 = 5_000_000;
/// And in a millisecond, which is a step of the simulated home.
pub const CYCLES_PER_MS: u64 = 5_000;
