//! The firmware of a robot as a host process: cordlib on a simulated board.
//!
//! [`SimulatedRobot`] joins a [`home::World`], a serial line paced in virtual time ([`SerialLine`]) and cordlib. One
//! [`SimulatedRobot::tick`] is one millisecond. It uses no clock, no thread and no device: the same calls give the same
//! bits, at any speed. The [`monitor::Monitor`] checks in every millisecond whether a motor ran against the rules.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod board;
pub mod charging;
mod line;
mod parameters;
mod power;
mod robot;
mod sensor_errors;

pub use board::{Outfit, Relax, Sr8730Outfit};
pub use line::SerialLine;
pub use parameters::parameters_for;
pub use power::ChargeSwitch;
pub use robot::{RobotSettings, SimulatedRobot};
pub use rvac_channel::FaultRates;
