//! The slave: one event a byte.

use super::{ClockPin, DataPin, I2c, ON, RELEASE, stop};
use crate::cpu;
use crate::register::map::{i2c_control, i2c_receive, i2c_status, i2c_transmit};

const STRICT: u32 = 1 << 11;
const TEN_BITS: u32 = 1 << 10;
const GENERAL_CALL: u32 = 1 << 7;
const STRETCH: u32 = 1 << 6;

const GENERAL_CALL_SEEN: u32 = 1 << 9;
const TEN_BITS_MATCHED: u32 = 1 << 8;
const OVERRUN: u32 = 1 << 6;
const DATA: u32 = 1 << 5;
const STOPPED: u32 = 1 << 4;
const READS: u32 = 1 << 2;

/// The slave's own address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Address {
    /// Seven bits.
    Seven(u8),
    /// Ten bits.
    Ten(u16),
}

/// An address that is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AddressError {
    /// More than seven bits.
    Seven(u8),
    /// More than ten bits.
    Ten(u16),
}

impl Address {
    /// I2CxADD and A10M.
    pub(super) const fn bits(self) -> Result<(u32, u32), AddressError> {
        match self {
            Self::Seven(address) if address > 0x7F => Err(AddressError::Seven(address)),
            Self::Ten(address) if address > 0x3FF => Err(AddressError::Ten(address)),
            Self::Seven(address) => Ok((address as u32, 0)),
            Self::Ten(address) => Ok((address as u32, TEN_BITS)),
        }
    }
}

/// What else it answers to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Answers {
    /// Bits of the address that may be anything.
    pub ignored_bits: u16,
    /// The general call, address 0 for writing.
    pub general_call: bool,
    /// Its own address even if that is a reserved one (0 to 7, 0x78 to 0x7F).
    pub reserved: bool,
}

impl Answers {
    pub(super) const fn bits(self) -> u32 {
        let call = if self.general_call { GENERAL_CALL } else { 0 };
        // A mask needs the strict rule to be off.
        let is_strict = !self.reserved && self.ignored_bits == 0;
        let strict = if is_strict { STRICT } else { 0 };
        call | strict | STRETCH
    }
}

/// What a master did. It waits until the event was taken, and for [`Self::Wanted`] until there is an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlaveEvent {
    /// A transfer begins, in which the master writes.
    Begins,
    /// The same for the general call.
    Called,
    /// A byte came.
    Received(u8),
    /// The master wants a byte, the first one after it addressed us (`true`) or a further one: [`I2cSlave::answer`].
    Wanted {
        /// It has just begun to read.
        is_first: bool,
    },
    /// A byte was lost, because the one before it had not been taken.
    Lost,
}

/// A slave.
#[derive(Debug)]
pub struct I2cSlave<const NUMBER: u8, D, C> {
    i2c: I2c<NUMBER>,
    pins: (D, C),
}

impl<const NUMBER: u8, D: DataPin<NUMBER>, C: ClockPin<NUMBER>> I2cSlave<NUMBER, D, C> {
    pub(super) const fn new(i2c: I2c<NUMBER>, pins: (D, C)) -> Self {
        Self { i2c, pins }
    }

    /// The next event, if there is one. A handler of the vector calls it once.
    pub fn take_event(&mut self) -> Option<SlaveEvent> {
        if !I2c::<NUMBER>::SLAVE.is_pending() {
            return None;
        }
        I2c::<NUMBER>::SLAVE.clear();
        let status = i2c_status(NUMBER).read();
        let byte = i2c_receive(NUMBER).read() as u8;
        if status & OVERRUN != 0 {
            i2c_status(NUMBER).clear(OVERRUN);
            i2c_control(NUMBER).set(RELEASE);
            return Some(SlaveEvent::Lost);
        }
        if status & READS != 0 {
            let is_first = status & DATA == 0;
            return Some(SlaveEvent::Wanted { is_first });
        }
        let is_half_address =
            i2c_control(NUMBER).has(TEN_BITS) && status & (DATA | GENERAL_CALL_SEEN | TEN_BITS_MATCHED) == 0;
        i2c_control(NUMBER).set(RELEASE);
        if is_half_address {
            return None;
        }
        Some(match (status & DATA != 0, status & GENERAL_CALL_SEEN != 0) {
            (true, _) => SlaveEvent::Received(byte),
            (false, true) => SlaveEvent::Called,
            (false, false) => SlaveEvent::Begins,
        })
    }

    /// Gives the byte that the master waits for.
    pub fn answer(&mut self, byte: u8) {
        // A store that an interrupt cuts in two may be done twice (errata of the family, as told by others).
        cpu::without_interrupts(|| i2c_transmit(NUMBER).write(u32::from(byte)));
        i2c_control(NUMBER).set(RELEASE);
    }

    /// Whether the last transfer on the bus has ended with a stop, which is no event.
    #[must_use]
    pub fn has_stopped(&self) -> bool {
        i2c_status(NUMBER).has(STOPPED)
    }

    /// Lets go of the bus and forgets what it was in the middle of.
    pub fn restart(&mut self) {
        i2c_control(NUMBER).clear(ON);
        i2c_control(NUMBER).set(ON | RELEASE);
    }

    /// Stops it and gives the parts back.
    #[must_use]
    pub fn release(self) -> (I2c<NUMBER>, (D, C)) {
        stop::<NUMBER>();
        (self.i2c, self.pins)
    }
}

#[cfg(test)]
mod tests {
    use super::{Address, AddressError, Answers, SlaveEvent};
    use crate::gpio::Pins;
    use crate::i2c::I2c;
    use crate::interrupt::Source;
    use crate::register::map::{i2c_address, i2c_control, i2c_mask, i2c_receive, i2c_status, i2c_transmit};

    /// The bits of I2CxCON, I2CxADD and I2CxMSK, and each event by the status that makes it; on I2C 2 of memory.
    #[test]
    fn a_slave_sets_its_bits_and_tells_events_by_the_status() {
        let pins = Pins::new();
        let lines = (pins.ra3.into_input(), pins.ra2.into_input());
        let slave = I2c::<2>::new().into_slave(lines, Address::Seven(0x42), Answers::default());
        let (i2c, lines) = slave.expect("seven bits").release();
        let many = Answers {
            ignored_bits: 3,
            general_call: true,
            reserved: false,
        };
        let slave = i2c.into_slave(lines, Address::Ten(0x2A5), many);
        let mut slave = slave.expect("ten bits");
        assert_eq!((i2c_address(2).read(), i2c_mask(2).read()), (0x2A5, 3));
        let on = 1 << 15 | 1 << 12;
        assert_eq!(i2c_control(2).read(), on | 1 << 10 | 1 << 7 | 1 << 6);

        assert_eq!(slave.take_event(), None);
        i2c_receive(2).write(0x5A);
        Source::I2c2Slave.request();
        i2c_status(2).write(0);
        assert_eq!(slave.take_event(), None, "half an address of ten bits");
        for (status, event) in [
            (1 << 8, SlaveEvent::Begins),
            (1 << 9, SlaveEvent::Called),
            (1 << 5, SlaveEvent::Received(0x5A)),
            (1 << 5 | 1 << 9, SlaveEvent::Received(0x5A)),
            (1 << 6 | 1 << 5, SlaveEvent::Lost),
            (1 << 2, SlaveEvent::Wanted { is_first: true }),
            (1 << 5 | 1 << 2, SlaveEvent::Wanted { is_first: false }),
        ] {
            i2c_status(2).write(status);
            i2c_control(2).clear(1 << 12);
            Source::I2c2Slave.request();
            assert_eq!(slave.take_event(), Some(event), "{status:#x}");
            assert!(!Source::I2c2Slave.is_pending());
            let waits = matches!(event, SlaveEvent::Wanted { .. });
            assert_eq!(
                i2c_control(2).has(1 << 12),
                !waits,
                "the clock is held for an answer only"
            );
        }
        slave.answer(0xC3);
        assert_eq!(
            (i2c_transmit(2).read(), i2c_control(2).has(1 << 12)),
            (0xC3, true)
        );
        i2c_status(2).write(1 << 4);
        assert!(slave.has_stopped());
    }

    #[test]
    fn addresses_and_answers_are_checked() {
        assert_eq!(Address::Seven(0x80).bits(), Err(AddressError::Seven(0x80)));
        assert_eq!(Address::Ten(0x400).bits(), Err(AddressError::Ten(0x400)));
        assert_eq!(Answers::default().bits(), 1 << 11 | 1 << 6, "strict");
        let reserved = Answers {
            reserved: true,
            ..Answers::default()
        };
        assert_eq!(reserved.bits(), 1 << 6);
    }
}
