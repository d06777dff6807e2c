//! The firmware of a robot as a host process: cordlib on simulated pins, "one more board".
//!
//! [`SimulatedRobot`] joins a [`home::World`], a serial line paced in virtual time ([`SerialLine`]) and cordlib. One
//! [`SimulatedRobot::tick`] is one millisecond. It knows no clock, no thread and no device: the same calls give the same
//! bits, at any speed. The [`monitor::Monitor`] judges every millisecond whether motors ran that must not.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod board;
pub mod charging;
mod line;
mod parameters;
mod power;
mod robot;

pub use board::{Outfit, Relax, Sr8730Outfit};
pub use line::SerialLine;
pub use parameters::parameters_for;
pub use power::ChargeSwitch;
pub use robot::{RobotSettings, SimulatedRobot};
pub use rvac_channel::FaultRates;
