//! I2C 1 and 2: master and slave (section 2 of the peripherals).
//!
//! Both lines need resistors to the supply; the chip has none. A [`I2cMaster`] is `embedded_hal::i2c::I2c` and waits for each step,
//! with a limit, because a slave may hold the clock as long as it likes. A [`I2cSlave`] is told of each byte by the vectors
//! [`I2C_1`](crate::interrupt::vector::I2C_1) and [`I2C_2`](crate::interrupt::vector::I2C_2), and holds the clock until it was served.
//!
//! `unverified`: the delay of the pulse gobbler (104 ns) in the divider, and what reserved addresses do. The chip's errata are said to
//! name the slave; try it on your silicon before you rely on it.

mod master;
mod slave;

pub use master::{I2cError, I2cMaster, Step};
pub use slave::{Address, AddressError, Answers, I2cSlave, SlaveEvent};

use crate::gpio::{Input, Pin, Port};
use crate::interrupt::Source;
use crate::register::map::{i2c_address, i2c_control, i2c_divider, i2c_mask, i2c_status};

const ON: u32 = 1 << 15;
const RELEASE: u32 = 1 << 12;
/// DISSLW: no limit to how fast the lines fall, for 100 kHz and 1 MHz.
const FAST_EDGES: u32 = 1 << 9;

/// The smallest divider that the part allows.
const DIVIDER_MIN: u32 = 2;
const DIVIDER_MAX: u32 = 0xFFF;

/// I2C `NUMBER`, 1 or 2, off.
#[derive(Debug)]
pub struct I2c<const NUMBER: u8>(());

/// The data line's pin, SDA: an input, which the chip pulls low by itself.
pub trait DataPin<const I2C: u8>: sealed::BusPin {}
/// The clock line's pin, SCL.
pub trait ClockPin<const I2C: u8>: sealed::BusPin {}

mod sealed {
    use crate::gpio::Port;

    /// A pin that can be driven by hand, to free a bus.
    pub trait BusPin {
        fn line(&self) -> (Port, u16);
    }
}

impl<const PORT: char, const NUMBER: u8> sealed::BusPin for Pin<PORT, NUMBER, Input> {
    fn line(&self) -> (Port, u16) {
        (self.port(), self.bit())
    }
}

impl DataPin<1> for Pin<'G', 3, Input> {}
impl ClockPin<1> for Pin<'G', 2, Input> {}
impl DataPin<2> for Pin<'A', 3, Input> {}
impl ClockPin<2> for Pin<'A', 2, Input> {}

/// How fast a master clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speed {
    /// 100 kHz.
    Standard,
    /// 400 kHz.
    Fast,
    /// 1 MHz.
    FastPlus,
}

impl Speed {
    const fn hz(self) -> u64 {
        match self {
            Self::Standard => 100_000,
            Self::Fast => 400_000,
            Self::FastPlus => 1_000_000,
        }
    }

    const fn edges(self) -> u32 {
        match self {
            Self::Standard | Self::FastPlus => FAST_EDGES,
            Self::Fast => 0,
        }
    }
}

/// A speed that cannot be made from this peripheral clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpeedError {
    /// The wanted speed.
    pub wanted: Speed,
    /// The peripheral clock, in hertz.
    pub peripheral_hz: u32,
}

/// The divider: half a period less the 104 ns that the filter of the inputs takes, rounded to the slower side.
fn divider(wanted: Speed, peripheral_hz: u32) -> Result<u32, SpeedError> {
    const FILTER_NS: u64 = 104;
    let half_ns = 500_000_000 / wanted.hz();
    let clocks = (u64::from(peripheral_hz) * (half_ns - FILTER_NS)).div_ceil(1_000_000_000) as u32;
    clocks
        .checked_sub(2)
        .filter(|divider| (DIVIDER_MIN..=DIVIDER_MAX).contains(divider))
        .ok_or(SpeedError {
            wanted,
            peripheral_hz,
        })
}

impl<const NUMBER: u8> I2c<NUMBER> {
    /// Source of requests: a step of the master is done.
    pub const MASTER: Source = match NUMBER {
        1 => Source::I2c1Master,
        2 => Source::I2c2Master,
        _ => panic!("I2Cs are 1 and 2"),
    };
    /// Source of requests: a byte for the slave, or from it.
    pub const SLAVE: Source = match NUMBER {
        1 => Source::I2c1Slave,
        2 => Source::I2c2Slave,
        _ => panic!("I2Cs are 1 and 2"),
    };
    /// Source of requests: somebody else drove the bus.
    pub const COLLISION: Source = match NUMBER {
        1 => Source::I2c1Collision,
        2 => Source::I2c2Collision,
        _ => panic!("I2Cs are 1 and 2"),
    };

    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Starts it as master. `peripheral_hz` is PBCLK; a step that takes longer than `patience_counts` of the core timer ends with
    /// [`I2cError::Timeout`].
    ///
    /// # Errors
    /// [`SpeedError`] when the divider cannot make this speed.
    pub fn into_master<D: DataPin<NUMBER>, C: ClockPin<NUMBER>>(
        self,
        pins: (D, C),
        (speed, peripheral_hz): (Speed, u32),
        patience_counts: u32,
    ) -> Result<I2cMaster<NUMBER, D, C>, SpeedError> {
        let divider = divider(speed, peripheral_hz)?;
        stop::<NUMBER>();
        i2c_divider(NUMBER).write(divider);
        i2c_status(NUMBER).write(0);
        i2c_control(NUMBER).write(RELEASE | speed.edges());
        i2c_control(NUMBER).set(ON);
        Ok(I2cMaster::new(self, pins, patience_counts))
    }

    /// Starts it as slave.
    ///
    /// # Errors
    /// [`AddressError`] for an address with more bits than it may have.
    pub fn into_slave<D: DataPin<NUMBER>, C: ClockPin<NUMBER>>(
        self,
        pins: (D, C),
        address: Address,
        answers: Answers,
    ) -> Result<I2cSlave<NUMBER, D, C>, AddressError> {
        let (address, ten_bits) = address.bits()?;
        stop::<NUMBER>();
        i2c_address(NUMBER).write(address);
        i2c_mask(NUMBER).write(u32::from(answers.ignored_bits));
        // A divider is needed by none but a master; 0 and 1 are not allowed.
        i2c_divider(NUMBER).write(DIVIDER_MAX);
        i2c_status(NUMBER).write(0);
        i2c_control(NUMBER).write(RELEASE | ten_bits | answers.bits());
        i2c_control(NUMBER).set(ON);
        Ok(I2cSlave::new(self, pins))
    }
}

/// Off; the lines are let go.
fn stop<const NUMBER: u8>() {
    for source in [
        I2c::<NUMBER>::MASTER,
        I2c::<NUMBER>::SLAVE,
        I2c::<NUMBER>::COLLISION,
    ] {
        source.disable();
    }
    i2c_control(NUMBER).write(RELEASE);
    for source in [
        I2c::<NUMBER>::MASTER,
        I2c::<NUMBER>::SLAVE,
        I2c::<NUMBER>::COLLISION,
    ] {
        source.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::{Speed, SpeedError, divider};

    /// The table of section 2.4 for 80 MHz, and clocks that are too slow.
    #[test]
    fn dividers_are_those_of_the_table() {
        for (speed, value) in [(Speed::Standard, 390), (Speed::Fast, 90), (Speed::FastPlus, 30)] {
            assert_eq!(divider(speed, 80_000_000), Ok(value), "{speed:?}");
        }
        assert_eq!(divider(Speed::Standard, 8_000_000), Ok(38));
        for (wanted, peripheral_hz) in [(Speed::FastPlus, 4_000_000), (Speed::Standard, 500_000)] {
            assert_eq!(
                divider(wanted, peripheral_hz),
                Err(SpeedError {
                    wanted,
                    peripheral_hz
                })
            );
        }
    }
}
