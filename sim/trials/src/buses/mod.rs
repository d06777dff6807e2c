//! Masters of SPI and I2C on the pins of the emulated chip, under the host's real end of each link.
//!
//! A master drives its lines edge by edge and reads what the chip does to them. What it clocks through is also read at the
//! chip's own pins, for the judge: it has to know what the robot heard, whatever the cable made of it.

mod cable;
mod i2c;
mod listener;
mod noise;
mod spi;

pub use cable::Cable;
pub use i2c::{I2cFailure, I2cMaster, I2cWires};
pub use spi::{SpiMaster, SpiWires};

use pic32::board::{CYCLES_PER_S, EmulatedRobot};

/// A host's driver takes so long between two transfers.
const DRIVER_CYCLES: u64 = CYCLES_PER_S * 50 / 1_000_000;

/// The cycle that the chip has reached.
fn now(robot: &EmulatedRobot) -> u64 {
    robot.machine().cycle()
}

/// The chip runs up to a cycle. Its serial line ends nowhere.
fn advance(robot: &mut EmulatedRobot, cycle: u64) {
    robot.advance_to(cycle, &mut Vec::new());
}
