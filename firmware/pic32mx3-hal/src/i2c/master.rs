//! The master: `embedded_hal::i2c::I2c` with seven and ten bits of address.

use super::{ClockPin, DataPin, I2c, ON, stop};
use crate::gpio::Port;
use crate::register::map::{i2c_control, i2c_receive, i2c_status, i2c_transmit};
use crate::{core_timer, cpu};
use core::fmt;
use embedded_hal::i2c::{
    ErrorKind, ErrorType, NoAcknowledgeSource, Operation, SevenBitAddress, TenBitAddress,
};

const START: u32 = 1;
const RESTART: u32 = 1 << 1;
const STOP: u32 = 1 << 2;
const RECEIVE: u32 = 1 << 3;
const ACKNOWLEDGE: u32 = 1 << 4;
const NOT_ACKNOWLEDGE: u32 = 1 << 5;
const STEPS: u32 = START | RESTART | STOP | RECEIVE | ACKNOWLEDGE;

const NOT_ACKNOWLEDGED: u32 = 1 << 15;
const TRANSMITS: u32 = 1 << 14;
const COLLISION: u32 = 1 << 10;
const WRITE_COLLISION: u32 = 1 << 7;
const OVERRUN: u32 = 1 << 6;
const TRANSMIT_FULL: u32 = 1;

/// The step in which something went wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Start or repeated start.
    Start,
    /// An address.
    Address,
    /// A byte that was sent.
    Send,
    /// A byte that was to come.
    Receive,
    /// Stop.
    Stop,
}

/// Why a transfer failed. The bus was given back with a stop, except after a collision or a time-out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum I2cError {
    /// Nobody has this address.
    NoDevice,
    /// The device did not acknowledge a byte.
    Refused,
    /// Somebody else drove the bus in this step: a second master, or a device that holds data low. See
    /// [`I2cMaster::recover`].
    Collision(Step),
    /// This step did not end in time: a device holds the clock, or a line has no resistor.
    Timeout(Step),
    /// The chip was given a byte in the midst of another one.
    Busy,
}

impl fmt::Display for I2cError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDevice => formatter.write_str("no device acknowledged the address"),
            Self::Refused => formatter.write_str("the device did not acknowledge a byte"),
            Self::Collision(step) => write!(formatter, "another one drove the bus in step {step:?}"),
            Self::Timeout(step) => write!(formatter, "step {step:?} did not end in time"),
            Self::Busy => formatter.write_str("a byte was given while another one was being sent"),
        }
    }
}

impl core::error::Error for I2cError {}

impl embedded_hal::i2c::Error for I2cError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::NoDevice => ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address),
            Self::Refused => ErrorKind::NoAcknowledge(NoAcknowledgeSource::Data),
            Self::Collision(_) => ErrorKind::ArbitrationLoss,
            Self::Timeout(_) => ErrorKind::Bus,
            Self::Busy => ErrorKind::Other,
        }
    }
}

/// A master.
#[derive(Debug)]
pub struct I2cMaster<const NUMBER: u8, D, C> {
    i2c: I2c<NUMBER>,
    data: D,
    clock: C,
    patience_counts: u32,
}

/// Which way bytes go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    Write,
    Read,
}

/// An address as it goes over the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BusAddress {
    Seven(u8),
    Ten(u16),
}

impl BusAddress {
    /// The first byte, with its direction.
    const fn first(self, direction: Direction) -> u8 {
        let upper = match self {
            Self::Seven(address) => address << 1,
            Self::Ten(address) => 0xF0 | ((address >> 7) as u8 & 0b110),
        };
        upper | direction as u8
    }

    /// The second one, if there is one.
    const fn second(self) -> Option<u8> {
        match self {
            Self::Seven(_) => None,
            Self::Ten(address) => Some(address as u8),
        }
    }
}

impl<const NUMBER: u8, D: DataPin<NUMBER>, C: ClockPin<NUMBER>> I2cMaster<NUMBER, D, C> {
    pub(super) fn new(i2c: I2c<NUMBER>, (data, clock): (D, C), patience_counts: u32) -> Self {
        Self {
            i2c,
            data,
            clock,
            patience_counts,
        }
    }

    /// Frees a bus whose data line a device holds, as after a reset within a byte: up to nine clocks by hand, then a stop. Whether
    /// both lines are high then. `half_period_counts` is half a period of the clock in counts of the core timer.
    pub fn recover(&mut self, half_period_counts: u32) -> bool {
        const CLOCKS: usize = 9;
        i2c_control(NUMBER).clear(ON);
        let (data, clock) = (self.data.line(), self.clock.line());
        for line in [data, clock] {
            let_go(line);
            line.0.set_open_drain(line.1);
            line.0.drive(line.1);
        }
        for _ in 0..CLOCKS {
            core_timer::wait_counts(half_period_counts);
            if is_high(data) {
                break;
            }
            pull(clock);
            core_timer::wait_counts(half_period_counts);
            let_go(clock);
        }
        // A stop: data rises while the clock is high.
        for (line, change) in [
            (clock, pull as fn(_)),
            (data, pull),
            (clock, let_go),
            (data, let_go),
        ] {
            change(line);
            core_timer::wait_counts(half_period_counts);
        }
        let is_free = is_high(data) && is_high(clock);
        for line in [data, clock] {
            line.0.release(line.1);
            line.0.clear_open_drain(line.1);
        }
        i2c_status(NUMBER).clear(COLLISION | WRITE_COLLISION | OVERRUN);
        i2c_control(NUMBER).set(ON);
        is_free
    }

    /// Stops it and gives the parts back.
    #[must_use]
    pub fn release(self) -> (I2c<NUMBER>, (D, C)) {
        stop::<NUMBER>();
        (self.i2c, (self.data, self.clock))
    }

    /// Waits until a step has ended, with a limit.
    fn wait(&self, step: Step, is_over: impl Fn() -> bool) -> Result<(), I2cError> {
        let begun = core_timer::count();
        while !is_over() {
            if core_timer::count().wrapping_sub(begun) > self.patience_counts {
                return Err(I2cError::Timeout(step));
            }
        }
        if i2c_status(NUMBER).has(COLLISION) {
            i2c_status(NUMBER).clear(COLLISION);
            return Err(I2cError::Collision(step));
        }
        Ok(())
    }

    /// One step that a bit of I2CxCON begins, and that the chip clears at its end.
    fn step(&mut self, bit: u32, step: Step) -> Result<(), I2cError> {
        i2c_control(NUMBER).set(bit);
        self.wait(step, || i2c_control(NUMBER).read() & STEPS == 0)
    }

    /// Sends a byte; whether it was acknowledged.
    fn send(&mut self, byte: u8, step: Step) -> Result<bool, I2cError> {
        // A store that an interrupt cuts in two may be done twice (errata of the family, as told by others).
        cpu::without_interrupts(|| i2c_transmit(NUMBER).write(u32::from(byte)));
        if i2c_status(NUMBER).has(WRITE_COLLISION) {
            i2c_status(NUMBER).clear(WRITE_COLLISION);
            return Err(I2cError::Busy);
        }
        self.wait(step, || {
            i2c_status(NUMBER).read() & (TRANSMITS | TRANSMIT_FULL) == 0
        })?;
        Ok(!i2c_status(NUMBER).has(NOT_ACKNOWLEDGED))
    }

    /// Receives a byte and acknowledges it unless it is the last.
    fn receive(&mut self, is_last: bool) -> Result<u8, I2cError> {
        self.step(RECEIVE, Step::Receive)?;
        let byte = i2c_receive(NUMBER).read() as u8;
        if is_last {
            i2c_control(NUMBER).set(NOT_ACKNOWLEDGE);
        } else {
            i2c_control(NUMBER).clear(NOT_ACKNOWLEDGE);
        }
        self.step(ACKNOWLEDGE, Step::Receive)?;
        Ok(byte)
    }

    /// Addresses the device in a direction, after a start.
    fn address(&mut self, address: BusAddress, direction: Direction, restarts: bool) -> Result<(), I2cError> {
        let reads = direction == Direction::Read;
        let acknowledged = match address.second() {
            // Reading with ten bits: first both bytes for writing, then the first one anew.
            Some(second) if !(reads && restarts) => {
                self.send(address.first(Direction::Write), Step::Address)?
                    && self.send(second, Step::Address)?
                    && (!reads || {
                        self.step(RESTART, Step::Start)?;
                        self.send(address.first(Direction::Read), Step::Address)?
                    })
            }
            _ => self.send(address.first(direction), Step::Address)?,
        };
        acknowledged.then_some(()).ok_or(I2cError::NoDevice)
    }

    fn operate(&mut self, address: BusAddress, operations: &mut [Operation<'_>]) -> Result<(), I2cError> {
        let mut present = None;
        let count = operations.len();
        for index in 0..count {
            let reads_next = operations
                .get(index + 1)
                .is_some_and(|next| matches!(next, Operation::Read(_)));
            let Some(operation) = operations.get_mut(index) else {
                break;
            };
            let direction = match operation {
                Operation::Read(_) => Direction::Read,
                Operation::Write(_) => Direction::Write,
            };
            if present != Some(direction) {
                let restarts = present.is_some();
                self.step(if restarts { RESTART } else { START }, Step::Start)?;
                self.address(address, direction, restarts)?;
                present = Some(direction);
            }
            match operation {
                Operation::Write(bytes) => {
                    for byte in bytes.iter() {
                        if !self.send(*byte, Step::Send)? {
                            return Err(I2cError::Refused);
                        }
                    }
                }
                Operation::Read(bytes) => {
                    let last = bytes.len().saturating_sub(1);
                    for (place, byte) in bytes.iter_mut().enumerate() {
                        *byte = self.receive(place == last && !reads_next)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn transfer(&mut self, address: BusAddress, operations: &mut [Operation<'_>]) -> Result<(), I2cError> {
        if operations.is_empty() {
            return Ok(());
        }
        i2c_status(NUMBER).clear(COLLISION | WRITE_COLLISION | OVERRUN);
        match self.operate(address, operations) {
            Ok(()) => self.step(STOP, Step::Stop),
            // The bus is not ours.
            Err(error @ (I2cError::Collision(_) | I2cError::Timeout(_))) => {
                i2c_control(NUMBER).clear(ON);
                i2c_control(NUMBER).set(ON);
                Err(error)
            }
            Err(error) => {
                self.step(STOP, Step::Stop)?;
                Err(error)
            }
        }
    }
}

fn pull(line: (Port, u16)) {
    line.0.clear(line.1);
}

fn let_go(line: (Port, u16)) {
    line.0.set(line.1);
}

fn is_high(line: (Port, u16)) -> bool {
    line.0.read() & line.1 != 0
}

impl<const NUMBER: u8, D, C> ErrorType for I2cMaster<NUMBER, D, C> {
    type Error = I2cError;
}

impl<const NUMBER: u8, D: DataPin<NUMBER>, C: ClockPin<NUMBER>> embedded_hal::i2c::I2c<SevenBitAddress>
    for I2cMaster<NUMBER, D, C>
{
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), I2cError> {
        self.transfer(BusAddress::Seven(address), operations)
    }
}

impl<const NUMBER: u8, D: DataPin<NUMBER>, C: ClockPin<NUMBER>> embedded_hal::i2c::I2c<TenBitAddress>
    for I2cMaster<NUMBER, D, C>
{
    fn transaction(&mut self, address: u16, operations: &mut [Operation<'_>]) -> Result<(), I2cError> {
        self.transfer(BusAddress::Ten(address), operations)
    }
}

#[cfg(test)]
mod tests {
    use super::{BusAddress, Direction, I2cError, Step};
    use crate::gpio::Pins;
    use crate::i2c::{I2c, Speed};
    use crate::register::map::{i2c_control, i2c_divider, i2c_status, i2c_transmit};
    use embedded_hal::i2c::I2c as _;

    #[test]
    fn addresses_of_ten_bits_take_two_bytes() {
        let ten = BusAddress::Ten(0x2A5);
        assert_eq!(
            (
                ten.first(Direction::Write),
                ten.first(Direction::Read),
                ten.second()
            ),
            (0xF4, 0xF5, Some(0xA5))
        );
        let seven = BusAddress::Seven(0x42);
        assert_eq!(
            (
                seven.first(Direction::Write),
                seven.first(Direction::Read),
                seven.second()
            ),
            (0x84, 0x85, None)
        );
    }

    /// The bits of I2CxCON and I2CxBRG, and that a bus which never answers ends in a named time-out of its first step; on I2C 1
    /// of memory, which keeps the bit that the chip would clear.
    #[test]
    fn a_master_sets_its_bits_and_does_not_wait_for_ever() {
        let pins = Pins::new();
        let lines = (pins.rg3.into_input(), pins.rg2.into_input());
        let master = I2c::<1>::new().into_master(lines, (Speed::Fast, 80_000_000), 1_000);
        let mut master = master.expect("400 kHz can be made");
        assert_eq!(
            (i2c_control(1).read(), i2c_divider(1).read()),
            (1 << 15 | 1 << 12, 90)
        );
        assert_eq!(master.write(0x42_u8, &[1]), Err(I2cError::Timeout(Step::Start)));
        assert_eq!(i2c_control(1).read() & 0x1F, 1, "SEN was set");
        let (i2c, lines) = master.release();
        assert_eq!(i2c_control(1).read(), 1 << 12);

        let master = i2c.into_master(lines, (Speed::Standard, 80_000_000), 1_000);
        let mut master = master.expect("100 kHz can be made");
        assert_eq!(i2c_control(1).read(), 1 << 15 | 1 << 12 | 1 << 9, "DISSLW");
        i2c_status(1).write(1 << 15);
        assert_eq!(master.send(0xA5, Step::Send), Ok(false), "not acknowledged");
        assert_eq!(i2c_transmit(1).read(), 0xA5);
        i2c_status(1).write(1 << 7);
        assert_eq!(master.send(0xA5, Step::Send), Err(I2cError::Busy));
        i2c_status(1).write(1 << 14);
        assert_eq!(master.send(0xA5, Step::Send), Err(I2cError::Timeout(Step::Send)));
        i2c_status(1).write(1 << 10);
        assert_eq!(
            master.send(0xA5, Step::Address),
            Err(I2cError::Collision(Step::Address))
        );
        assert_eq!(i2c_status(1).read(), 0, "forgotten");
    }
}
