//! The parallel port: a bus of 8 or 16 data lines with up to 16 address lines, as master; or as slave on the bus of another machine
//! (section 7 of the peripherals). For displays, memories, and chips among each other.
//!
//! `unverified`: a master takes what was read while the port is off for a moment, because its register starts an access whenever it
//! is read; the level of the direction line of [`Strobes::Combined`] when nothing moves; the slave modes in Sleep.

mod lines;
mod master;
mod slave;

pub use lines::{AddressLines, AddressPin, BusWord, DataPins, DataPins8, DataPins16};
pub use master::{Increment, MasterSettings, ParallelMaster, Strobes, WaitClocks};
pub use slave::{ParallelSlave, SlaveError, SlaveLevels};

use crate::interrupt::Source;

const ON: u32 = 1 << 15;
const WRITE_STROBE: u32 = 1 << 9;
const READ_STROBE: u32 = 1 << 8;
const SELECT_2_HIGH: u32 = 1 << 4;
const SELECT_1_HIGH: u32 = 1 << 3;
const WRITE_HIGH: u32 = 1 << 1;
const READ_HIGH: u32 = 1 << 0;
/// IRQM: an interrupt for each access.
const EACH_ACCESS: u32 = 1 << 13;

/// The parallel port, off.
#[derive(Debug)]
pub struct ParallelPort(());

/// The level at which a line says yes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActiveLevel {
    /// Low.
    Low,
    /// High.
    High,
}

impl ActiveLevel {
    /// The bit when it is high.
    const fn bit(self, bit: u32) -> u32 {
        match self {
            Self::Low => 0,
            Self::High => bit,
        }
    }
}

impl ParallelPort {
    /// Its source of interrupts: the end of an access.
    pub const SOURCE: Source = Source::ParallelPort;

    pub(crate) const fn new() -> Self {
        Self(())
    }
}

#[cfg(test)]
mod tests {
    use super::{DataPins8, DataPins16};
    use crate::gpio::Pins;
    use std::sync::{Mutex, MutexGuard, PoisonError};

    /// The registers are one memory for all tests.
    pub(super) fn alone() -> MutexGuard<'static, ()> {
        static TURN: Mutex<()> = Mutex::new(());
        TURN.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The lower data lines, and other pins.
    pub(super) fn data_8(pins: Pins) -> (DataPins8, Pins) {
        let data = (
            pins.re0.into_input(),
            pins.re1.into_input(),
            pins.re2.into_input(),
            pins.re3.into_input(),
            pins.re4.into_input(),
            pins.re5.into_input(),
            pins.re6.into_input(),
            pins.re7.into_input(),
        );
        (data, Pins::new())
    }

    /// All data lines, and other pins.
    pub(super) fn data_16(pins: Pins) -> (DataPins16, Pins) {
        let upper = (
            pins.rg0.into_input(),
            pins.rg1.into_input(),
            pins.rf1.into_input(),
            pins.rf0.into_input(),
            pins.rd12.into_input(),
            pins.rd13.into_input(),
            pins.rd6.into_input(),
            pins.rd7.into_input(),
        );
        let (lower, pins) = data_8(Pins::new());
        ((lower, upper), pins)
    }
}
