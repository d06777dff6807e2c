//! An SPI master by DMA.

use super::transfer::{LengthError, Plan, Side, Start};
use super::uart::register;
use super::{Channel, ChannelPriority, Element, Lent, TransferError, WriteBuffer};
use crate::register::map::{spi_buffer, spi_status};
use crate::spi::{Spi, SpiMaster, Word};
use core::marker::PhantomData;

/// Both channels of an exchange.
type Pair<const RECEIVING: u8, const SENDING: u8> = (Channel<RECEIVING>, Channel<SENDING>);

/// A master that sends the words of a buffer and puts those that come in their places.
#[derive(Debug)]
#[must_use = "buffer, master and channels come back by `wait`, `try_finish` or `stop`"]
pub struct Exchange<const RECEIVING: u8, const SENDING: u8, M, B: WriteBuffer> {
    channels: Pair<RECEIVING, SENDING>,
    master: M,
    lent: Lent<B::Element>,
    buffer: PhantomData<fn(B)>,
}

/// What comes of an exchange.
#[derive(Debug)]
pub struct Exchanged<const RECEIVING: u8, const SENDING: u8, M, B> {
    /// Both channels.
    pub channels: (Channel<RECEIVING>, Channel<SENDING>),
    /// The master.
    pub master: M,
    /// What came, as far as words were exchanged.
    pub buffer: B,
    /// Words that were exchanged.
    pub moved: usize,
    /// Whether something went wrong.
    pub outcome: Result<(), TransferError>,
}

impl<const NUMBER: u8, W: Word + Element, P> SpiMaster<NUMBER, W, P> {
    /// Exchanges the words of a buffer for those of the other side, without a pause. The channel that receives gets the highest
    /// priority, so that no word is lost.
    ///
    /// # Errors
    /// [`LengthError`] when the buffer is empty or has more than 256 bytes.
    pub fn exchange_by_dma<const RECEIVING: u8, const SENDING: u8, B: WriteBuffer<Element = W>>(
        mut self,
        (mut receiving, mut sending): (Channel<RECEIVING>, Channel<SENDING>),
        buffer: B,
    ) -> Result<
        Exchange<RECEIVING, SENDING, Self, B>,
        LengthError<((Channel<RECEIVING>, Channel<SENDING>), Self, B)>,
    > {
        let lent = buffer.lend();
        if let Err(error) = LengthError::check(lent.bytes(), ()) {
            // SAFETY: lent above, and no channel was started.
            let buffer = unsafe { B::reclaim(lent) };
            return Err(LengthError {
                bytes: error.bytes,
                parts: ((receiving, sending), self, buffer),
            });
        }
        self.prepare_for_dma();
        let width = size_of::<W>();
        let own = register(spi_buffer(NUMBER), width);
        let receive = Plan {
            source: own,
            destination: Side::of(&lent),
            cell_bytes: width,
            start: Start::Each(Spi::<NUMBER>::RECEIVED),
            until: None,
            repeats: false,
        };
        receiving.set_priority(ChannelPriority::Highest);
        receiving.begin(&receive);
        sending.begin(&Plan {
            source: Side::of(&lent),
            destination: own,
            start: Start::EachAndNow(Spi::<NUMBER>::SENT),
            ..receive
        });
        Ok(Exchange {
            channels: (receiving, sending),
            master: self,
            lent,
            buffer: PhantomData,
        })
    }

    /// Both buffers are empty, and nobody else serves their requests.
    fn prepare_for_dma(&mut self) {
        const OVERRUN: u32 = 1 << 6;
        for source in [Spi::<NUMBER>::SENT, Spi::<NUMBER>::RECEIVED, Spi::<NUMBER>::FAULT] {
            source.disable();
        }
        while !self.has_drained() {}
        let _ = spi_buffer(NUMBER).read();
        spi_status(NUMBER).clear(OVERRUN);
        for source in [Spi::<NUMBER>::SENT, Spi::<NUMBER>::RECEIVED, Spi::<NUMBER>::FAULT] {
            source.clear();
        }
    }
}

impl<const RECEIVING: u8, const SENDING: u8, const NUMBER: u8, W, P, B>
    Exchange<RECEIVING, SENDING, SpiMaster<NUMBER, W, P>, B>
where
    W: Word + Element,
    B: WriteBuffer<Element = W>,
{
    /// Whether the last word has come, or something went wrong.
    #[must_use]
    pub fn is_over(&self) -> bool {
        !Channel::<RECEIVING>::is_running() || Channel::<SENDING>::outcome().is_err()
    }

    /// Words that came up to now; 0 when it is over.
    #[must_use]
    pub fn progress(&self) -> usize {
        Channel::<RECEIVING>::pointers().1 / size_of::<W>()
    }

    /// What there is when it is over, or the same again.
    ///
    /// # Errors
    /// The exchange itself, which is still under way.
    pub fn try_finish(self) -> Result<Exchanged<RECEIVING, SENDING, SpiMaster<NUMBER, W, P>, B>, Self> {
        if self.is_over() {
            Ok(self.stop())
        } else {
            Err(self)
        }
    }

    /// Waits for the last word.
    pub fn wait(self) -> Exchanged<RECEIVING, SENDING, SpiMaster<NUMBER, W, P>, B> {
        while !self.is_over() {}
        self.stop()
    }

    /// Ends it now; words that are under way come before that.
    pub fn stop(self) -> Exchanged<RECEIVING, SENDING, SpiMaster<NUMBER, W, P>, B> {
        let said = Channel::<RECEIVING>::outcome().and(Channel::<SENDING>::outcome());
        Channel::<SENDING>::halt();
        // At most two words are under way; a channel takes them as they come.
        while !self.master.has_drained() || Channel::<RECEIVING>::is_running() && self.master.has_received() {
        }
        let pointers = Channel::<RECEIVING>::halt();
        let is_complete = Channel::<RECEIVING>::is_block_done();
        Channel::<RECEIVING>::acknowledge();
        Channel::<SENDING>::acknowledge();
        let moved = match is_complete {
            true => self.lent.len(),
            false => pointers.1 / size_of::<W>(),
        };
        let outcome = match said {
            Ok(()) if Spi::<NUMBER>::FAULT.is_pending() => Err(TransferError::Peripheral),
            said => said,
        };
        // SAFETY: lent when it began, and both channels are off.
        let buffer = unsafe { B::reclaim(self.lent) };
        Exchanged {
            channels: self.channels,
            master: self.master,
            buffer,
            moved,
            outcome,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::dma::tests::{alone, end_block};
    use crate::dma::{Channel, StaticBuffer, TransferError};
    use crate::gpio::{Level, Pins};
    use crate::interrupt::Source;
    use crate::register::map::{
        dma_cell_size, dma_control, dma_destination, dma_destination_pointer, dma_destination_size,
        dma_event, dma_source, dma_source_size, spi_status,
    };
    use crate::spi::Spi;
    use embedded_hal::spi::MODE_0;

    #[test]
    fn an_exchange_sets_up_both_channels_and_counts_what_came() {
        static WORDS: StaticBuffer<u16, 3> = StaticBuffer::new([1, 2, 3]);
        let _alone = alone();
        let pins = Pins::new();
        let pins = (
            pins.rg6.into_output(Level::Low),
            pins.rg8.into_output(Level::Low),
            pins.rg7.into_input(),
        );
        let hz = (1_000_000, 80_000_000);
        let master = Spi::<2>::new()
            .into_master::<u16, _, _, _>(pins, MODE_0, hz)
            .expect("1 MHz can be made");
        spi_status(2).write(1 << 3 | 1 << 6);
        let words = WORDS.take().expect("the first time");
        let place = core::ptr::from_ref(words).addr() as u32 & 0x1FFF_FFFF;
        let exchange = master
            .exchange_by_dma((Channel::<1>::new(), Channel::<0>::new()), words)
            .expect("6 bytes");
        assert_eq!(spi_status(2).read(), 1 << 3, "an overrun of before is forgotten");
        assert_eq!(
            [dma_source(1).read(), dma_destination(1).read()],
            [0x1F80_5A20, place]
        );
        assert_eq!(
            [dma_source(0).read(), dma_destination(0).read()],
            [place, 0x1F80_5A20]
        );
        let sizes = |number| {
            [
                dma_source_size(number),
                dma_destination_size(number),
                dma_cell_size(number),
            ]
        };
        assert_eq!(sizes(1).map(|size| size.read()), [2, 6, 2]);
        assert_eq!(sizes(0).map(|size| size.read()), [6, 2, 2]);
        assert_eq!(dma_control(1).read() & 0x83, 0x83, "the highest priority");
        assert_eq!(dma_event(1).read(), 39 << 8 | 1 << 4);
        assert_eq!(dma_event(0).read(), 38 << 8 | 1 << 4 | 1 << 7);
        dma_destination_pointer(1).write(4);
        assert_eq!((exchange.progress(), exchange.is_over()), (2, false));
        let stopped = exchange.stop();
        assert_eq!((stopped.moved, stopped.outcome), (2, Ok(())));
        dma_destination_pointer(1).write(0);

        let exchange = stopped
            .master
            .exchange_by_dma(stopped.channels, stopped.buffer)
            .expect("6 bytes");
        end_block(1, 1 << 3);
        Source::Spi2Fault.request();
        let finished = exchange.try_finish().expect("the last word came");
        assert_eq!(
            (finished.moved, finished.outcome),
            (3, Err(TransferError::Peripheral))
        );
        Source::Spi2Fault.clear();
        for number in [0, 1] {
            dma_control(number).write(0);
        }
    }
}
