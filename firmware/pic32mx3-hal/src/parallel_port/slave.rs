//! The slave: a byte each way, which the other machine's strobes take and give.

use super::{
    ActiveLevel, DataPins8, EACH_ACCESS, ON, ParallelPort, READ_HIGH, READ_STROBE, SELECT_1_HIGH, WRITE_HIGH,
    WRITE_STROBE,
};
use crate::gpio::{Input, Pin};
use crate::register::map::{PMAEN, PMCON, PMDIN, PMDOUT, PMMODE, PMSTAT};
use core::fmt;

/// CSF: PMCS1 is a select.
const SELECTS: u32 = 2 << 6;
/// PTEN of PMCS1.
const SELECT_PIN: u32 = 1 << 14;

const INPUT_FULL: u32 = 1 << 15;
const OVERFLOW: u32 = 1 << 14;
const OUTPUT_EMPTY: u32 = 1 << 7;
const UNDERFLOW: u32 = 1 << 6;

/// The levels at which the other machine's lines are active.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SlaveLevels {
    /// That of PMCS1.
    pub select: ActiveLevel,
    /// That of PMRD.
    pub read: ActiveLevel,
    /// That of PMWR.
    pub write: ActiveLevel,
}

/// A byte that the other machine sent was lost, because the one before it was not taken in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SlaveError;

impl fmt::Display for SlaveError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a byte was lost because the one before it was not taken in time")
    }
}

impl core::error::Error for SlaveError {}

/// PMCS1, PMRD, PMWR.
type SlavePins = (Pin<'D', 11, Input>, Pin<'D', 5, Input>, Pin<'D', 4, Input>);

/// A slave. Serve it in a handler of [`PARALLEL_PORT`](crate::interrupt::vector::PARALLEL_PORT), which is called after each
/// access of the other machine.
#[derive(Debug)]
pub struct ParallelSlave {
    port: ParallelPort,
    pins: (DataPins8, SlavePins),
}

impl ParallelPort {
    /// Starts it as slave.
    #[must_use]
    pub fn into_slave(self, pins: (DataPins8, SlavePins), levels: SlaveLevels) -> ParallelSlave {
        PMCON.write(0);
        PMMODE.write(EACH_ACCESS);
        PMAEN.write(SELECT_PIN);
        PMSTAT.clear(OVERFLOW | UNDERFLOW);
        Self::SOURCE.clear();
        let levels =
            levels.select.bit(SELECT_1_HIGH) | levels.read.bit(READ_HIGH) | levels.write.bit(WRITE_HIGH);
        PMCON.write(READ_STROBE | WRITE_STROBE | SELECTS | levels);
        PMCON.set(ON);
        ParallelSlave { port: self, pins }
    }
}

impl ParallelSlave {
    /// The byte that the other machine wrote, or that one was lost since; `None` when there is none.
    ///
    /// # Errors
    /// [`SlaveError`]; the byte that came first is still there.
    pub fn try_receive(&mut self) -> Option<Result<u8, SlaveError>> {
        let status = PMSTAT.read();
        if status & OVERFLOW != 0 {
            PMSTAT.clear(OVERFLOW);
            return Some(Err(SlaveError));
        }
        (status & INPUT_FULL != 0).then(|| Ok(PMDIN.read() as u8))
    }

    /// Gives a byte for the other machine to read; `false` when one waits already.
    pub fn try_send(&mut self, byte: u8) -> bool {
        let has_room = PMSTAT.has(OUTPUT_EMPTY);
        if has_room {
            PMDOUT.write(u32::from(byte));
        }
        has_room
    }

    /// Whether the other machine read since the last call while there was nothing for it.
    pub fn take_underflow(&mut self) -> bool {
        let happened = PMSTAT.has(UNDERFLOW);
        PMSTAT.clear(UNDERFLOW);
        happened
    }

    /// Stops it and gives the parts back.
    #[must_use]
    pub fn release(self) -> (ParallelPort, (DataPins8, SlavePins)) {
        ParallelPort::SOURCE.disable();
        PMCON.write(0);
        PMAEN.write(0);
        (self.port, self.pins)
    }
}

#[cfg(test)]
mod tests {
    use super::{SlaveError, SlaveLevels};
    use crate::gpio::Pins;
    use crate::parallel_port::tests::{alone, data_8};
    use crate::parallel_port::{ActiveLevel, ParallelPort};
    use crate::register::map::{PMAEN, PMCON, PMDIN, PMDOUT, PMMODE, PMSTAT};

    #[test]
    fn a_slave_sets_its_bits_and_follows_its_status() {
        let _alone = alone();
        let (data, pins) = data_8(Pins::new());
        let lines = (
            pins.rd11.into_input(),
            pins.rd5.into_input(),
            pins.rd4.into_input(),
        );
        let levels = SlaveLevels {
            select: ActiveLevel::High,
            read: ActiveLevel::Low,
            write: ActiveLevel::High,
        };
        let mut slave = ParallelPort::new().into_slave((data, lines), levels);
        assert_eq!(PMMODE.read(), 1 << 13);
        assert_eq!(PMAEN.read(), 1 << 14);
        assert_eq!(PMCON.read(), 1 << 15 | 1 << 9 | 1 << 8 | 2 << 6 | 1 << 3 | 1 << 1);
        PMSTAT.write(0);
        assert_eq!(slave.try_receive(), None);
        assert!(!slave.try_send(1) && !slave.take_underflow());
        PMDIN.write(0x5A);
        PMSTAT.write(1 << 15 | 1 << 14 | 1 << 7 | 1 << 6);
        assert_eq!(slave.try_receive(), Some(Err(SlaveError)));
        assert_eq!(slave.try_receive(), Some(Ok(0x5A)));
        assert!(slave.try_send(0xA5));
        assert_eq!(PMDOUT.read(), 0xA5);
        assert!(slave.take_underflow() && !slave.take_underflow());
        let _ = slave.release();
        assert_eq!((PMCON.read(), PMAEN.read()), (0, 0));
    }
}
