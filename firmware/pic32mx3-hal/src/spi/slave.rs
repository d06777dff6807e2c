//! The slave: words are given before the master clocks, and taken after.

use super::{BUSY, ON, ROOM, Spi, SpiError, Word, stop, try_receive, try_send};
use crate::register::map::{spi_control, spi_status};
use core::marker::PhantomData;

/// A slave that the pin SS selects, or that always is. Give it the first word before the master begins, and each further one while the word
/// before it moves.
#[derive(Debug)]
pub struct SpiSlave<const NUMBER: u8, W, P> {
    spi: Spi<NUMBER>,
    pins: P,
    word: PhantomData<fn(W)>,
}

impl<const NUMBER: u8, W: Word, P> SpiSlave<NUMBER, W, P> {
    pub(super) const fn new(spi: Spi<NUMBER>, pins: P) -> Self {
        let word = PhantomData;
        Self { spi, pins, word }
    }

    /// Gives a word to be sent when the master clocks next; `false` when one waits already.
    #[inline(always)]
    pub fn try_send(&mut self, word: W) -> bool {
        try_send::<NUMBER, W>(word)
    }

    /// Whether there is room for a word.
    #[inline(always)]
    #[must_use]
    pub fn has_room(&self) -> bool {
        spi_status(NUMBER).has(ROOM)
    }

    /// The word that came, or that one was lost; `None` when nothing came. A handler takes until there is none, then clears
    /// [`Spi::RECEIVED`] and [`Spi::FAULT`].
    ///
    /// # Errors
    /// [`SpiError::Overrun`]: the words of this transfer are no longer in step.
    #[inline(always)]
    pub fn try_receive(&mut self) -> Option<Result<W, SpiError>> {
        try_receive::<NUMBER, W>()
    }

    /// Whether a word is being clocked.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        spi_status(NUMBER).has(BUSY)
    }

    /// Forgets what waits to be sent and what came: for the moment at which the master lets go of SS, so that the next
    /// transfer begins with a fresh word.
    pub fn restart(&mut self) {
        spi_control(NUMBER).clear(ON);
        spi_control(NUMBER).set(ON);
    }

    /// The pins, to read the level of SS.
    #[must_use]
    pub const fn pins(&self) -> &P {
        &self.pins
    }

    /// Stops it and gives the parts back.
    #[must_use]
    pub fn release(self) -> (Spi<NUMBER>, P) {
        stop::<NUMBER>();
        (self.spi, self.pins)
    }
}

#[cfg(test)]
mod tests {
    use crate::gpio::{Level, Pins};
    use crate::register::map::{spi_buffer, spi_control, spi_divider, spi_status};
    use crate::spi::{Follows, FramePulse, Leads, PulseLevel, PulsePlace, Spi, SpiError};
    use embedded_hal::spi::{MODE_0, MODE_1, Polarity};

    /// The slave's and the framed bits of SPIxCON, and what the status says, on SPI 2.
    #[test]
    fn a_slave_and_frames_set_their_bits() {
        // DMA's tests use the same registers.
        let _alone = crate::dma::tests::alone();
        let pins = Pins::new();
        let slave_pins = (
            pins.rg6.into_input(),
            pins.rg8.into_output(Level::Low),
            pins.rg7.into_input(),
            pins.rg9.into_input(),
        );
        let mut slave = Spi::<2>::new().into_slave::<u16, _, _, _, _>(slave_pins, MODE_0);
        assert_eq!(spi_control(2).read(), 1 << 15 | 1 << 10 | 1 << 8 | 1 << 7);
        spi_status(2).write(0);
        assert!(!slave.try_send(7), "one waits");
        assert_eq!(slave.try_receive(), None);
        spi_status(2).write(1 << 3 | 1 << 11);
        assert!(slave.try_send(0xBEEF) && slave.is_busy() && slave.has_room());
        assert_eq!(spi_buffer(2).read(), 0xBEEF);
        spi_status(2).write(1);
        assert_eq!(slave.try_receive(), Some(Ok(0xBEEF)));
        spi_status(2).write(1 | 1 << 6);
        assert_eq!(slave.try_receive(), Some(Err(SpiError::Overrun)));
        slave.restart();
        assert_eq!(spi_control(2).read() & 1 << 15, 1 << 15);
        let (spi, (clock, output, input, select)) = slave.release();
        assert_eq!(spi_control(2).read(), 0);
        let slave = spi.into_slave::<u8, _, _, _, _>((clock, output, input, select), MODE_1);
        assert_eq!(spi_control(2).read(), 1 << 15 | 1 << 7);
        let (spi, (clock, output, input, select)) = slave.release();
        let always = spi.into_slave_without_select::<u8, _, _, _>((clock, output, input), Polarity::IdleHigh);
        assert_eq!(spi_control(2).read(), 1 << 15 | 1 << 6, "neither SSEN nor CKE");
        let (spi, (clock, output, input)) = always.release();

        let pulse = FramePulse {
            level: PulseLevel::High,
            place: PulsePlace::WithFirstBit,
        };
        let pins = (Follows(clock), output, input, Follows(select));
        let framed = spi.into_framed::<u8, _, _, _, _>(pins, Polarity::IdleHigh, pulse);
        let expected = 1 << 31 | 1 << 30 | 1 << 29 | 1 << 17 | 1 << 15 | 1 << 6;
        assert_eq!(spi_control(2).read(), expected);
        let (spi, (clock, output, input, select)) = framed.release();
        assert_eq!(spi_control(2).read(), 0);

        let pulse = FramePulse {
            level: PulseLevel::Low,
            place: PulsePlace::BeforeFirstBit,
        };
        let clock = Leads(clock.0.into_output(Level::Low));
        let pins = (clock, output, input, Leads(select.0.into_output(Level::High)));
        let mut framed = spi.into_framed::<u32, _, _, _, _>(pins, Polarity::IdleLow, pulse);
        assert_eq!(spi_control(2).read(), 1 << 31 | 1 << 15 | 1 << 11 | 1 << 5);
        assert_eq!(spi_divider(2).read(), 511);
        assert_eq!(framed.set_frequency(1_000_000, 80_000_000), Ok(()));
        assert_eq!(
            (spi_divider(2).read(), spi_control(2).read() & 1 << 15),
            (39, 1 << 15)
        );
        assert!(framed.set_frequency(1, 80_000_000).is_err());
    }
}
