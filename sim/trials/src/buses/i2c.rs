//! A master of I2C at 400 kHz on the pins of the chip, which waits while the chip holds the clock.

use pic32::board::{CYCLES_PER_S, EmulatedRobot, I2cPlaces};
use pic32::pins::{Level, Pin};
use robot_link::I2cBus;

use super::listener::{BusListener, StreamByte};
use super::noise::PulseFault;
use super::{Cable, DRIVER_CYCLES, advance, now};

const PLACES: I2cPlaces = I2cPlaces::SR8730;
const ADDRESS: u8 = 0x2A;
/// A quarter of a bit.
const QUARTER_CYCLES: u64 = CYCLES_PER_S / 400_000 / 4;
/// How often the master looks whether a clock that is held is let go.
const LOOK_CYCLES: u64 = 20;
/// Longest time that a slave may hold the clock: what the kernel's driver of a common board waits.
const HELD_CYCLES: u64 = CYCLES_PER_S * 35 / 1_000;

/// Why a transfer failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum I2cFailure {
    /// Nobody acknowledged.
    #[error("nobody acknowledged")]
    NotAcknowledged,
    /// A line stayed low.
    #[error("a line is held low")]
    Held,
}

/// The master, and the cable to the chip.
#[derive(Clone, Debug)]
pub struct I2cMaster {
    /// The cable.
    pub cable: Cable,
    /// Whether the master lets go of its lines.
    clock: bool,
    data: bool,
    listener: BusListener,
}

impl I2cMaster {
    /// A bus at rest, with resistors to the supply.
    #[must_use]
    pub fn new(robot: &mut EmulatedRobot) -> Self {
        for pin in [PLACES.data, PLACES.clock] {
            robot.machine_mut().pull_up(pin);
            robot.machine_mut().release_input(pin);
        }
        Self {
            cable: Cable::new(PLACES.attention),
            clock: true,
            data: true,
            listener: BusListener::default(),
        }
    }
}

/// The master at work on a robot.
#[derive(Debug)]
pub struct I2cWires<'a> {
    /// The robot.
    pub robot: &'a mut EmulatedRobot,
    /// The master.
    pub master: &'a mut I2cMaster,
}

impl I2cWires<'_> {
    /// Puts on the chip's pins what the master does, lets time pass, and listens.
    fn pass(&mut self, cycles: u64) {
        let begin = now(self.robot);
        let is_out = self.master.cable.is_out(begin);
        let lines = [(PLACES.data, self.master.data), (PLACES.clock, self.master.clock)];
        for (pin, is_free) in lines {
            let machine = self.robot.machine_mut();
            if is_free || is_out {
                machine.release_input(pin);
            } else {
                machine.set_input(pin, Level::Low);
            }
        }
        advance(self.robot, begin + cycles);
        let machine = self.robot.machine();
        let [clock, data] = [PLACES.clock, PLACES.data].map(|pin| machine.level(pin).is_high());
        match self.master.listener.look((clock, data)) {
            None => {}
            Some(StreamByte::Heard(byte)) => self.robot.carried_by_bus([byte], []),
            Some(StreamByte::Said(byte)) => {
                self.master.cable.say(Some(byte));
                self.robot.carried_by_bus([], [byte]);
            }
        }
    }

    /// The level that the master sees.
    fn sees(&self, pin: Pin, is_free: bool) -> bool {
        let is_out = self.master.cable.is_out(now(self.robot));
        is_free && (is_out || self.robot.machine().level(pin).is_high())
    }

    /// Lets go of the clock and waits until the slave does.
    fn raise_clock(&mut self) -> Result<(), I2cFailure> {
        self.master.clock = true;
        let limit = now(self.robot) + HELD_CYCLES;
        loop {
            self.pass(LOOK_CYCLES);
            if self.sees(PLACES.clock, true) {
                return Ok(());
            }
            if now(self.robot) > limit {
                return Err(I2cFailure::Held);
            }
        }
    }

    fn lower_clock(&mut self) {
        self.master.clock = false;
        self.pass(QUARTER_CYCLES);
    }

    /// Puts a bit on the line, damaged or not.
    fn put_bit(&mut self, level: bool) -> Result<(), I2cFailure> {
        let level = self.master.cable.bit(level);
        self.clock_bit(level).map(drop)
    }

    /// Lets go of the line and takes the bit of the robot, damaged or not: on its own pins it stays what the robot has sent.
    fn take_bit(&mut self) -> Result<bool, I2cFailure> {
        let seen = self.clock_bit(true)?;
        Ok(self.master.cable.bit(seen))
    }

    /// One bit; `true` lets go of the line. Gives what the master sees.
    fn clock_bit(&mut self, level: bool) -> Result<bool, I2cFailure> {
        self.master.data = level;
        self.pass(QUARTER_CYCLES);
        let pulse = self.master.cable.pulse();
        let pulses = match pulse {
            PulseFault::None => 1,
            PulseFault::Lost => 0,
            PulseFault::Doubled => 2,
        };
        let mut seen = self.sees(PLACES.data, self.master.data);
        for _ in 0..pulses {
            self.raise_clock()?;
            self.pass(QUARTER_CYCLES);
            if self.master.cable.strikes() {
                // A spike on the data line while the clock is high: a start or a stop that nobody made.
                self.master.data = !self.master.data;
                self.pass(QUARTER_CYCLES / 2);
                self.master.data = !self.master.data;
            }
            seen = self.sees(PLACES.data, self.master.data);
            self.pass(QUARTER_CYCLES);
            self.lower_clock();
        }
        Ok(seen)
    }

    /// A start, or a start within a transfer.
    fn start(&mut self) -> Result<(), I2cFailure> {
        self.master.data = true;
        self.pass(QUARTER_CYCLES);
        self.raise_clock()?;
        self.pass(2 * QUARTER_CYCLES);
        if !self.sees(PLACES.data, true) {
            return Err(I2cFailure::Held);
        }
        self.master.data = false;
        self.pass(2 * QUARTER_CYCLES);
        self.lower_clock();
        Ok(())
    }

    fn stop(&mut self) -> Result<(), I2cFailure> {
        self.master.data = false;
        self.pass(QUARTER_CYCLES);
        let held = self.raise_clock();
        self.pass(2 * QUARTER_CYCLES);
        self.master.data = true;
        self.pass(DRIVER_CYCLES);
        held
    }

    fn put_byte(&mut self, byte: u8) -> Result<(), I2cFailure> {
        for bit in (0..8).rev() {
            self.put_bit(byte >> bit & 1 != 0)?;
        }
        match self.take_bit()? {
            false => Ok(()),
            true => Err(I2cFailure::NotAcknowledged),
        }
    }

    fn take_byte(&mut self, acknowledges: bool) -> Result<u8, I2cFailure> {
        let mut byte = 0;
        for _ in 0..8 {
            byte = byte << 1 | u8::from(self.take_bit()?);
        }
        self.put_bit(!acknowledges)?;
        Ok(byte)
    }

    fn address(&mut self, reads: bool) -> Result<(), I2cFailure> {
        self.start()?;
        self.put_byte(ADDRESS << 1 | u8::from(reads))
    }

    fn read_bytes(&mut self, register: u8, bytes: &mut [u8]) -> Result<(), I2cFailure> {
        self.address(false)?;
        self.put_byte(register)?;
        self.address(true)?;
        let last = bytes.len().saturating_sub(1);
        for (number, byte) in bytes.iter_mut().enumerate() {
            *byte = self.take_byte(number < last)?;
        }
        Ok(())
    }

    fn write_bytes(&mut self, register: u8, bytes: &[u8]) -> Result<(), I2cFailure> {
        self.address(false)?;
        for byte in std::iter::once(&register).chain(bytes) {
            self.put_byte(*byte)?;
        }
        Ok(())
    }
}

impl I2cBus for I2cWires<'_> {
    type Error = I2cFailure;

    fn read(&mut self, register: u8, bytes: &mut [u8]) -> Result<(), I2cFailure> {
        let read = self.read_bytes(register, bytes);
        let stopped = self.stop();
        read.and(stopped)
    }

    fn write(&mut self, register: u8, bytes: &[u8]) -> Result<(), I2cFailure> {
        let written = self.write_bytes(register, bytes);
        let stopped = self.stop();
        written.and(stopped)
    }
}
