//! SPI 1 and 2: master, slave, framed (section 1 of the peripherals).
//!
//! There is no queue: one word waits while one moves. A [`SpiMaster`] exchanges word by word and so loses none, however long
//! interrupts hold it up. A [`SpiSlave`] must be served within a word's time, by handlers of the vectors
//! [`SPI_1`](crate::interrupt::vector::SPI_1) and [`SPI_2`](crate::interrupt::vector::SPI_2).
//!
//! `unverified`: what a slave sends that was not loaded in time, the highest clock of a slave, and where exactly a frame's
//! pulse begins. The chip's errata are said to name the framed mode; try it on your silicon before you rely on it.

mod framed;
mod master;
mod slave;

pub use framed::{ClockRole, Follows, FramePulse, FrameRole, Framed, Leads, PulseLevel, PulsePlace};
pub use master::SpiMaster;
pub use slave::SpiSlave;

use crate::cpu;
use crate::gpio::{Input, Output, Pin};
use crate::interrupt::Source;
use crate::register::map::{spi_buffer, spi_control, spi_divider, spi_status};
use crate::word::RegisterWord;
use core::fmt;
use embedded_hal::spi::{Mode, Phase, Polarity};

const ON: u32 = 1 << 15;
const MASTER: u32 = 1 << 5;
const IDLE_HIGH: u32 = 1 << 6;
const SELECT: u32 = 1 << 7;
/// CKE: data changes with the edge back to idle.
const CHANGE_TO_IDLE: u32 = 1 << 8;

const RECEIVED: u32 = 1;
const ROOM: u32 = 1 << 3;
const OVERRUN: u32 = 1 << 6;
const BUSY: u32 = 1 << 11;

/// The shortest period of the clock is 40 ns; the number is general knowledge of the family.
const FASTEST_HZ: u32 = 25_000_000;
/// The divider has nine bits.
const DIVIDER_MAX: u32 = 511;

/// SPI `NUMBER`, 1 or 2, off.
#[derive(Debug)]
pub struct Spi<const NUMBER: u8>(());

/// What a receiver can complain of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpiError {
    /// A word came before the one before it was taken; it is lost.
    Overrun,
}

impl fmt::Display for SpiError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a word was lost because the one before it was not taken in time")
    }
}

impl core::error::Error for SpiError {}

impl embedded_hal::spi::Error for SpiError {
    fn kind(&self) -> embedded_hal::spi::ErrorKind {
        embedded_hal::spi::ErrorKind::Overrun
    }
}

/// A clock that cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrequencyError {
    /// The wanted clock, in hertz.
    pub wanted_hz: u32,
    /// The slowest that this peripheral clock allows; the fastest is 25 MHz.
    pub slowest_hz: u32,
}

/// How many bits a word has: `u8`, `u16` or `u32`.
pub trait Word: RegisterWord {
    /// MODE16 and MODE32 of SPIxCON.
    #[doc(hidden)]
    const WIDTH: u32;
}

impl Word for u8 {
    const WIDTH: u32 = 0;
}
impl Word for u16 {
    const WIDTH: u32 = 1 << 10;
}
impl Word for u32 {
    const WIDTH: u32 = 1 << 11;
}

/// The pin of a master's clock.
pub trait ClockOutput<const SPI: u8> {}
/// The pin of a slave's clock.
pub trait ClockInput<const SPI: u8> {}
/// The pin that data leaves on, SDO.
pub trait DataOutput<const SPI: u8> {}
/// The pin that data comes in on, SDI.
pub trait DataInput<const SPI: u8> {}
/// The pin that selects a slave or takes a frame's pulse, SS.
pub trait SelectInput<const SPI: u8> {}
/// The pin that a frame's pulse leaves on, SS.
pub trait SelectOutput<const SPI: u8> {}

macro_rules! spi_pins {
    ($($spi:literal $clock:literal $clock_number:literal $data:literal $input:literal $output:literal $select:literal $select_number:literal;)*) => {
        $(impl ClockOutput<$spi> for Pin<$clock, $clock_number, Output> {}
        impl ClockInput<$spi> for Pin<$clock, $clock_number, Input> {}
        impl DataInput<$spi> for Pin<$data, $input, Input> {}
        impl DataOutput<$spi> for Pin<$data, $output, Output> {}
        impl SelectInput<$spi> for Pin<$select, $select_number, Input> {}
        impl SelectOutput<$spi> for Pin<$select, $select_number, Output> {})*
    };
}

// Those of the 100-pin package without USB: SCK, SDI, SDO, SS.
spi_pins! {
    1 'F' 6 'F' 7 8 'B' 2;
    2 'G' 6 'G' 7 8 'G' 9;
}

/// CKP and CKE of a mode.
const fn mode_bits(mode: Mode) -> u32 {
    let polarity = match mode.polarity {
        Polarity::IdleLow => 0,
        Polarity::IdleHigh => IDLE_HIGH,
    };
    let phase = match mode.phase {
        Phase::CaptureOnFirstTransition => CHANGE_TO_IDLE,
        Phase::CaptureOnSecondTransition => 0,
    };
    polarity | phase
}

/// The divider that makes the fastest clock which is not faster than wanted.
fn divider(wanted_hz: u32, peripheral_hz: u32) -> Result<u32, FrequencyError> {
    let error = FrequencyError {
        wanted_hz,
        slowest_hz: (peripheral_hz / 2).div_ceil(DIVIDER_MAX + 1),
    };
    if wanted_hz == 0 {
        return Err(error);
    }
    let wanted = wanted_hz.min(FASTEST_HZ);
    let halves = peripheral_hz.div_ceil(2 * wanted).max(1);
    if halves > DIVIDER_MAX + 1 {
        return Err(error);
    }
    Ok(halves - 1)
}

impl<const NUMBER: u8> Spi<NUMBER> {
    /// Source of requests: there is room for a word to send.
    pub const SENT: Source = match NUMBER {
        1 => Source::Spi1Sent,
        2 => Source::Spi2Sent,
        _ => panic!("SPIs are 1 and 2"),
    };
    /// Source of requests: a word came.
    pub const RECEIVED: Source = match NUMBER {
        1 => Source::Spi1Received,
        2 => Source::Spi2Received,
        _ => panic!("SPIs are 1 and 2"),
    };
    /// Source of requests: a word was lost.
    pub const FAULT: Source = match NUMBER {
        1 => Source::Spi1Fault,
        2 => Source::Spi2Fault,
        _ => panic!("SPIs are 1 and 2"),
    };

    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Starts it as master. `peripheral_hz` is PBCLK; the clock becomes the fastest that is not above `wanted_hz` and
    /// 25 MHz. Chips are selected by pins of your own.
    ///
    /// # Errors
    /// [`FrequencyError`] when the clock would have to be slower than the divider makes it.
    pub fn into_master<W: Word, C, O, I>(
        self,
        pins: (C, O, I),
        mode: Mode,
        (wanted_hz, peripheral_hz): (u32, u32),
    ) -> Result<SpiMaster<NUMBER, W, (C, O, I)>, FrequencyError>
    where
        C: ClockOutput<NUMBER>,
        O: DataOutput<NUMBER>,
        I: DataInput<NUMBER>,
    {
        let divider = divider(wanted_hz, peripheral_hz)?;
        start::<NUMBER>(divider, MASTER | mode_bits(mode) | W::WIDTH);
        Ok(SpiMaster::new(self, pins))
    }

    /// Starts it as slave that the pin SS selects, at low level.
    pub fn into_slave<W: Word, C, O, I, S>(
        self,
        pins: (C, O, I, S),
        mode: Mode,
    ) -> SpiSlave<NUMBER, W, (C, O, I, S)>
    where
        C: ClockInput<NUMBER>,
        O: DataOutput<NUMBER>,
        I: DataInput<NUMBER>,
        S: SelectInput<NUMBER>,
    {
        start::<NUMBER>(0, SELECT | mode_bits(mode) | W::WIDTH);
        SpiSlave::new(self, pins)
    }
}

impl<const NUMBER: u8> Spi<NUMBER> {
    /// Starts it as slave that is always selected, with SS left to other uses. The chip offers that for data that changes on the
    /// clock's leading edge only: modes 1 and 3, which differ in the clock's level at rest. [`SpiSlave::restart`] brings bits and
    /// words back into step.
    pub fn into_slave_without_select<W: Word, C, O, I>(
        self,
        pins: (C, O, I),
        polarity: Polarity,
    ) -> SpiSlave<NUMBER, W, (C, O, I)>
    where
        C: ClockInput<NUMBER>,
        O: DataOutput<NUMBER>,
        I: DataInput<NUMBER>,
    {
        let mode = Mode {
            polarity,
            phase: Phase::CaptureOnSecondTransition,
        };
        start::<NUMBER>(0, mode_bits(mode) | W::WIDTH);
        SpiSlave::new(self, pins)
    }
}

/// From off to on with these settings: the order of section 1.3.
fn start<const NUMBER: u8>(divider: u32, control: u32) {
    stop::<NUMBER>();
    let _ = spi_buffer(NUMBER).read();
    spi_divider(NUMBER).write(divider);
    spi_status(NUMBER).clear(OVERRUN);
    for source in [Spi::<NUMBER>::SENT, Spi::<NUMBER>::RECEIVED, Spi::<NUMBER>::FAULT] {
        source.clear();
    }
    spi_control(NUMBER).write(control);
    spi_control(NUMBER).set(ON);
}

/// Off; both buffers are empty then.
fn stop<const NUMBER: u8>() {
    for source in [Spi::<NUMBER>::SENT, Spi::<NUMBER>::RECEIVED, Spi::<NUMBER>::FAULT] {
        source.disable();
    }
    spi_control(NUMBER).write(0);
}

/// Gives a word to the transmit buffer; `false` when one waits there.
#[inline(always)]
fn try_send<const NUMBER: u8, W: Word>(word: W) -> bool {
    if !spi_status(NUMBER).has(ROOM) {
        return false;
    }
    // A store that an interrupt cuts in two may be done twice (errata of the family, as told by others).
    cpu::without_interrupts(|| spi_buffer(NUMBER).write(word.to_register()));
    true
}

/// The word that came, or that one was lost since.
#[inline(always)]
fn try_receive<const NUMBER: u8, W: Word>() -> Option<Result<W, SpiError>> {
    let status = spi_status(NUMBER).read();
    if status & OVERRUN != 0 {
        // The word that came first is dropped with those that were lost: what follows is whole again.
        let _ = spi_buffer(NUMBER).read();
        spi_status(NUMBER).clear(OVERRUN);
        return Some(Err(SpiError::Overrun));
    }
    (status & RECEIVED != 0).then(|| Ok(W::from_register(spi_buffer(NUMBER).read())))
}

#[cfg(test)]
mod tests {
    use super::{FrequencyError, divider, mode_bits};
    use embedded_hal::spi::{MODE_0, MODE_1, MODE_2, MODE_3};

    /// The table of section 1.4 for 80 MHz, what lies between its rows, and what the divider cannot make.
    #[test]
    fn dividers_are_those_of_the_table_and_never_make_a_faster_clock() {
        for (hz, value) in [
            (20_000_000, 1),
            (10_000_000, 3),
            (8_000_000, 4),
            (2_000_000, 19),
            (1_000_000, 39),
            (400_000, 99),
            (100_000, 399),
            (78_125, 511),
            // 10 MHz would be too fast.
            (9_999_999, 4),
            // 40 MHz is more than the part can.
            (40_000_000, 1),
        ] {
            assert_eq!(divider(hz, 80_000_000), Ok(value), "{hz} Hz");
        }
        assert_eq!(divider(25_000_000, 8_000_000), Ok(0), "4 MHz");
        for wanted_hz in [78_124, 0] {
            let slowest_hz = 78_125;
            assert_eq!(
                divider(wanted_hz, 80_000_000),
                Err(FrequencyError {
                    wanted_hz,
                    slowest_hz
                })
            );
        }
    }

    /// The pairs of section 1.1.
    #[test]
    fn modes_are_pairs_of_polarity_and_edge() {
        let bits = [MODE_0, MODE_1, MODE_2, MODE_3].map(mode_bits);
        assert_eq!(bits, [1 << 8, 0, 1 << 6 | 1 << 8, 1 << 6]);
    }
}
