//! Framed SPI: a pulse on SS announces each word, and the clock does not stop. For codecs and for chips among each other.

use super::{
    ClockInput, ClockOutput, DataInput, DataOutput, FrequencyError, MASTER, SelectInput, SelectOutput, Spi,
    SpiError, Word, divider, start, stop, try_receive, try_send,
};
use crate::register::map::spi_divider;
use core::marker::PhantomData;
use embedded_hal::spi::Polarity;

const FRAMED: u32 = 1 << 31;
const FRAME_INPUT: u32 = 1 << 30;
const FRAME_HIGH: u32 = 1 << 29;
const FRAME_WITH_FIRST_BIT: u32 = 1 << 17;

/// This side makes the clock or the pulses, on the output that is in it.
#[derive(Debug)]
pub struct Leads<P>(pub P);

/// The other side makes them; the input is in it. Where it makes the pulses, a word must be given before its pulse comes.
#[derive(Debug)]
pub struct Follows<P>(pub P);

/// Who makes the clock.
pub trait ClockRole<const SPI: u8> {
    /// MSTEN of SPIxCON.
    #[doc(hidden)]
    const CLOCK: u32;
}

impl<const SPI: u8, P: ClockOutput<SPI>> ClockRole<SPI> for Leads<P> {
    const CLOCK: u32 = MASTER;
}

impl<const SPI: u8, P: ClockInput<SPI>> ClockRole<SPI> for Follows<P> {
    const CLOCK: u32 = 0;
}

/// Who makes the pulses.
pub trait FrameRole<const SPI: u8> {
    /// FRMSYNC of SPIxCON.
    #[doc(hidden)]
    const FRAME: u32;
}

impl<const SPI: u8, P: SelectOutput<SPI>> FrameRole<SPI> for Leads<P> {
    const FRAME: u32 = 0;
}

impl<const SPI: u8, P: SelectInput<SPI>> FrameRole<SPI> for Follows<P> {
    const FRAME: u32 = FRAME_INPUT;
}

/// The level of a pulse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PulseLevel {
    /// SS is high and goes low.
    Low,
    /// SS is low and goes high.
    High,
}

/// When a pulse comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PulsePlace {
    /// In the clock before the first bit.
    BeforeFirstBit,
    /// Together with the first bit.
    WithFirstBit,
}

/// The pulse that announces a word; it is one clock long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FramePulse {
    /// Its level.
    pub level: PulseLevel,
    /// When it comes.
    pub place: PulsePlace,
}

/// A framed SPI. Data changes with the clock's edge away from idle.
#[derive(Debug)]
pub struct Framed<const NUMBER: u8, W, P> {
    spi: Spi<NUMBER>,
    pins: P,
    word: PhantomData<fn(W)>,
}

impl<const NUMBER: u8> Spi<NUMBER> {
    /// Starts it with frames. A side that makes the clock makes it with the divider that [`Framed::set_frequency`] sets,
    /// and at first with the slowest.
    pub fn into_framed<W: Word, C, O, I, S>(
        self,
        pins: (C, O, I, S),
        polarity: Polarity,
        pulse: FramePulse,
    ) -> Framed<NUMBER, W, (C, O, I, S)>
    where
        C: ClockRole<NUMBER>,
        O: DataOutput<NUMBER>,
        I: DataInput<NUMBER>,
        S: FrameRole<NUMBER>,
    {
        let polarity = match polarity {
            Polarity::IdleLow => 0,
            Polarity::IdleHigh => super::IDLE_HIGH,
        };
        let level = match pulse.level {
            PulseLevel::Low => 0,
            PulseLevel::High => FRAME_HIGH,
        };
        let place = match pulse.place {
            PulsePlace::BeforeFirstBit => 0,
            PulsePlace::WithFirstBit => FRAME_WITH_FIRST_BIT,
        };
        let control = FRAMED | C::CLOCK | S::FRAME | polarity | level | place | W::WIDTH;
        start::<NUMBER>(super::DIVIDER_MAX, control);
        Framed {
            spi: self,
            pins,
            word: PhantomData,
        }
    }
}

impl<const NUMBER: u8, W: Word, P> Framed<NUMBER, W, P> {
    /// The frequency of the clock that this side makes: the fastest that is not above `wanted_hz` and 25 MHz. What is being
    /// sent is lost.
    ///
    /// # Errors
    /// [`FrequencyError`] when the clock would have to be slower than the divider makes it.
    pub fn set_frequency(&mut self, wanted_hz: u32, peripheral_hz: u32) -> Result<(), FrequencyError> {
        let divider = divider(wanted_hz, peripheral_hz)?;
        let control = crate::register::map::spi_control(NUMBER);
        control.clear(super::ON);
        spi_divider(NUMBER).write(divider);
        control.set(super::ON);
        Ok(())
    }

    /// Gives a word to be sent; `false` when one waits already.
    pub fn try_send(&mut self, word: W) -> bool {
        try_send::<NUMBER, W>(word)
    }

    /// The word that came, or that one was lost; `None` when nothing came.
    ///
    /// # Errors
    /// [`SpiError::Overrun`] when a word was not taken before the next.
    pub fn try_receive(&mut self) -> Option<Result<W, SpiError>> {
        try_receive::<NUMBER, W>()
    }

    /// Stops it and gives the parts back.
    #[must_use]
    pub fn release(self) -> (Spi<NUMBER>, P) {
        stop::<NUMBER>();
        (self.spi, self.pins)
    }
}
