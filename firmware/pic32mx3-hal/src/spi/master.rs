//! The master: `embedded_hal::spi::SpiBus`.

use super::{BUSY, RECEIVED, ROOM, Spi, SpiError, Word, stop, try_receive, try_send};
use crate::register::map::spi_status;
use core::marker::PhantomData;
use embedded_hal::spi::{ErrorType, SpiBus};

/// A master that sends words of one length, `u8`, `u16` or `u32`.
#[derive(Debug)]
pub struct SpiMaster<const NUMBER: u8, W, P> {
    spi: Spi<NUMBER>,
    pins: P,
    word: PhantomData<fn(W)>,
}

impl<const NUMBER: u8, W: Word, P> SpiMaster<NUMBER, W, P> {
    pub(super) const fn new(spi: Spi<NUMBER>, pins: P) -> Self {
        let word = PhantomData;
        Self { spi, pins, word }
    }

    /// Sends one word and returns the one that came for it.
    ///
    /// # Errors
    /// [`SpiError::Overrun`] when a word had come before that nobody took.
    pub fn exchange(&mut self, word: W) -> Result<W, SpiError> {
        while !try_send::<NUMBER, W>(word) {}
        loop {
            if let Some(received) = try_receive::<NUMBER, W>() {
                return received;
            }
        }
    }

    /// Whether the last bit has left.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        !spi_status(NUMBER).has(BUSY)
    }

    /// Whether nothing waits and nothing moves: between two words it may look idle.
    pub(crate) fn has_drained(&self) -> bool {
        spi_status(NUMBER).has(ROOM) && self.is_idle()
    }

    pub(crate) fn has_received(&self) -> bool {
        spi_status(NUMBER).has(RECEIVED)
    }

    /// Stops it and gives the parts back.
    #[must_use]
    pub fn release(self) -> (Spi<NUMBER>, P) {
        stop::<NUMBER>();
        (self.spi, self.pins)
    }
}

impl<const NUMBER: u8, W, P> ErrorType for SpiMaster<NUMBER, W, P> {
    type Error = SpiError;
}

impl<const NUMBER: u8, W: Word, P> SpiBus<W> for SpiMaster<NUMBER, W, P> {
    /// Sends zeros meanwhile.
    fn read(&mut self, words: &mut [W]) -> Result<(), SpiError> {
        for word in words {
            *word = self.exchange(W::default())?;
        }
        Ok(())
    }

    fn write(&mut self, words: &[W]) -> Result<(), SpiError> {
        for word in words {
            self.exchange(*word)?;
        }
        Ok(())
    }

    /// The shorter side is filled with zeros, or what comes for it is dropped.
    fn transfer(&mut self, read: &mut [W], write: &[W]) -> Result<(), SpiError> {
        for index in 0..read.len().max(write.len()) {
            let came = self.exchange(write.get(index).copied().unwrap_or_default())?;
            if let Some(place) = read.get_mut(index) {
                *place = came;
            }
        }
        Ok(())
    }

    fn transfer_in_place(&mut self, words: &mut [W]) -> Result<(), SpiError> {
        for word in words {
            *word = self.exchange(*word)?;
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), SpiError> {
        while !self.is_idle() {}
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::gpio::{Input, Output, Pin};
    use crate::interrupt::Source;
    use crate::register::map::{spi_buffer, spi_control, spi_divider, spi_status};
    use crate::spi::{Spi, SpiError};
    use embedded_hal::spi::{MODE_0, MODE_3, SpiBus};

    type Pins = (Pin<'F', 6, Output>, Pin<'F', 8, Output>, Pin<'F', 7, Input>);

    fn pins() -> Pins {
        let pins = crate::gpio::Pins::new();
        (
            pins.rf6.into_output(crate::gpio::Level::Low),
            pins.rf8.into_output(crate::gpio::Level::Low),
            pins.rf7.into_input(),
        )
    }

    /// Each bit of SPIxCON, SPIxBRG and the interrupt enables, for all word lengths; then the words, as far as memory that
    /// keeps what is written is an SPI whose data line comes back.
    #[test]
    fn a_master_sets_its_bits_and_exchanges_words() {
        Source::Spi1Received.enable();
        let master = Spi::<1>::new().into_master::<u8, _, _, _>(pins(), MODE_0, (1_000_000, 80_000_000));
        let mut master = master.expect("1 MHz can be made");
        assert_eq!(spi_control(1).read(), 1 << 15 | 1 << 8 | 1 << 5);
        assert_eq!(spi_divider(1).read(), 39);
        assert!(
            !Source::Spi1Received.is_enabled(),
            "the requests of who had it before"
        );
        // Room to send, a word received.
        spi_status(1).write(1 << 3 | 1);
        let mut words = [0; 3];
        assert_eq!(master.transfer(&mut words, &[0x5A, 0xC3]), Ok(()));
        assert_eq!(words, [0x5A, 0xC3, 0], "the shorter side is filled with zeros");
        spi_status(1).write(1 << 3 | 1 << 6);
        assert_eq!(master.write(&[1]), Err(SpiError::Overrun));
        assert_eq!(spi_status(1).read(), 1 << 3, "forgotten");
        spi_status(1).write(1 << 11);
        assert!(!master.is_idle());
        let (spi, pins) = master.release();
        assert_eq!(spi_control(1).read(), 0);

        let master = spi.into_master::<u16, _, _, _>(pins, MODE_3, (25_000_000, 80_000_000));
        let (spi, pins) = master.expect("20 MHz can be made").release();
        let master = spi.into_master::<u32, _, _, _>(pins, MODE_3, (25_000_000, 80_000_000));
        let mut master = master.expect("20 MHz can be made");
        assert_eq!(spi_control(1).read(), 1 << 15 | 1 << 11 | 1 << 6 | 1 << 5);
        assert_eq!(spi_divider(1).read(), 1);
        spi_status(1).write(1 << 3 | 1);
        assert_eq!(master.exchange(0xDEAD_BEEF), Ok(0xDEAD_BEEF));
        assert_eq!(spi_buffer(1).read(), 0xDEAD_BEEF);
    }
}
