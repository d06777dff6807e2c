//! UARTs by DMA.

use super::ring::RingReceiver;
use super::transfer::{Driver, LengthError, Plan, Side, Start, Transfer, sealed};
use super::{Channel, ReadBuffer, WriteBuffer};
use crate::interrupt::Source;
use crate::register::Register;
use crate::register::map::{uart_receive, uart_transmit};
use crate::uart::{Receiver, Transmitter, Uart};

/// The register of a peripheral as one side of a transfer.
pub(super) fn register(register: Register, bytes: usize) -> Side {
    Side {
        address: register.physical_address(),
        bytes,
    }
}

impl<const UART: u8> Uart<UART> {
    pub(super) const SENT: Source = match UART {
        1 => Source::Uart1Sent,
        2 => Source::Uart2Sent,
        _ => panic!("UARTs are 1 and 2"),
    };
    pub(super) const RECEIVED: Source = match UART {
        1 => Source::Uart1Received,
        2 => Source::Uart2Received,
        _ => panic!("UARTs are 1 and 2"),
    };
    pub(super) const ERROR: Source = match UART {
        1 => Source::Uart1Error,
        2 => Source::Uart2Error,
        _ => panic!("UARTs are 1 and 2"),
    };
}

impl<const UART: u8, P> sealed::Sealed for Transmitter<UART, P> {}
impl<const UART: u8, P> Driver for Transmitter<UART, P> {
    fn has_failed(&self) -> bool {
        false
    }

    fn end(&mut self) {}
}

impl<const UART: u8, P> sealed::Sealed for Receiver<UART, P> {}
impl<const UART: u8, P> Driver for Receiver<UART, P> {
    fn has_failed(&self) -> bool {
        Uart::<UART>::ERROR.is_pending()
    }

    fn end(&mut self) {}
}

impl<const UART: u8, P> Transmitter<UART, P> {
    /// Sends bytes. The transfer is over when the last one is in the queue; [`Self::is_idle`] says when it has left. Waits first until
    /// all that was sent before has left.
    ///
    /// # Errors
    /// [`LengthError`] when there is none or more than 256.
    pub fn send_by_dma<const NUMBER: u8, R: ReadBuffer<Element = u8>>(
        self,
        channel: Channel<NUMBER>,
        bytes: R,
    ) -> Result<Transfer<NUMBER, Self, R>, LengthError<(Channel<NUMBER>, Self, R)>> {
        let lent = bytes.lend();
        let checked = LengthError::check(lent.bytes(), (channel, self, lent));
        let (channel, transmitter, lent) = checked.map_err(|error| {
            let (channel, transmitter, lent) = error.parts;
            LengthError {
                bytes: error.bytes,
                // SAFETY: lent above, and no channel was started.
                parts: (channel, transmitter, unsafe { R::reclaim(lent) }),
            }
        })?;
        while !transmitter.is_idle() {}
        let source = Uart::<UART>::SENT;
        source.disable();
        source.clear();
        let plan = Plan {
            source: Side::of(&lent),
            destination: register(uart_transmit(UART), 1),
            cell_bytes: 1,
            start: Start::EachAndNow(source),
            until: None,
            repeats: false,
        };
        Ok(Transfer::begin((channel, transmitter), lent, &plan))
    }
}

impl<const UART: u8, P> Receiver<UART, P> {
    /// Receives as many bytes as the buffer has, or until one of them is `last`. What came before it was called is dropped.
    ///
    /// # Errors
    /// [`LengthError`] when the buffer has no byte or more than 256.
    pub fn receive_by_dma<const NUMBER: u8, B: WriteBuffer<Element = u8>>(
        mut self,
        channel: Channel<NUMBER>,
        buffer: B,
        last: Option<u8>,
    ) -> Result<Transfer<NUMBER, Self, B>, LengthError<(Channel<NUMBER>, Self, B)>> {
        let lent = buffer.lend();
        if let Err(error) = LengthError::check(lent.bytes(), ()) {
            // SAFETY: lent above, and no channel was started.
            let buffer = unsafe { B::reclaim(lent) };
            return Err(LengthError {
                bytes: error.bytes,
                parts: (channel, self, buffer),
            });
        }
        self.prepare();
        let plan = Self::plan(Side::of(&lent), last);
        Ok(Transfer::begin((channel, self), lent, &plan))
    }

    /// Receives for ever into a ring of at most 256 bytes, which is read behind it. What came before is dropped.
    ///
    /// # Errors
    /// [`LengthError`] when the buffer has no byte or more than 256.
    pub fn receive_into_ring<const NUMBER: u8, B: WriteBuffer<Element = u8>>(
        mut self,
        channel: Channel<NUMBER>,
        buffer: B,
    ) -> Result<RingReceiver<NUMBER, UART, P, B>, LengthError<(Channel<NUMBER>, Self, B)>> {
        let lent = buffer.lend();
        if let Err(error) = LengthError::check(lent.bytes(), ()) {
            // SAFETY: lent above, and no channel was started.
            let buffer = unsafe { B::reclaim(lent) };
            return Err(LengthError {
                bytes: error.bytes,
                parts: (channel, self, buffer),
            });
        }
        self.prepare();
        let plan = Plan {
            repeats: true,
            ..Self::plan(Side::of(&lent), None)
        };
        Ok(RingReceiver::begin((channel, self), lent, &plan))
    }

    /// Empties the queue, and forgets what was wrong.
    fn prepare(&mut self) {
        for source in [Uart::<UART>::RECEIVED, Uart::<UART>::ERROR] {
            source.disable();
        }
        while self.try_read().is_some() {}
        for source in [Uart::<UART>::RECEIVED, Uart::<UART>::ERROR] {
            source.clear();
        }
    }

    fn plan(destination: Side, until: Option<u8>) -> Plan {
        Plan {
            source: register(uart_receive(UART), 1),
            destination,
            cell_bytes: 1,
            start: Start::Each(Uart::<UART>::RECEIVED),
            until,
            repeats: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::dma::tests::{alone, end_block};
    use crate::dma::{Channel, RingError, StaticBuffer, TransferError};
    use crate::gpio::{Input, Output, Pin};
    use crate::gpio::{Level, Pins};
    use crate::interrupt::Source;
    use crate::register::map::{
        dma_cell_size, dma_control, dma_destination, dma_destination_pointer, dma_destination_size,
        dma_event, dma_interrupt, dma_pattern, dma_source, dma_source_size, uart_status,
    };
    use crate::uart::{Receiver, Transmitter, Uart};

    type Halves = (
        Transmitter<2, Pin<'F', 5, Output>>,
        Receiver<2, Pin<'F', 4, Input>>,
    );

    /// UART 2, idle and with an empty queue.
    fn halves() -> Halves {
        let pins = Pins::new();
        let pins = (pins.rf5.into_output(Level::High), pins.rf4.into_input());
        let halves = Uart::<2>::new()
            .start(pins, 115_200, 80_000_000)
            .expect("the rate can be made");
        uart_status(2).write(1 << 8);
        halves
    }

    #[test]
    fn sending_writes_a_byte_for_each_request_and_forces_the_first() {
        let _alone = alone();
        let (transmitter, _) = halves();
        Source::Uart2Sent.request();
        let sending = transmitter
            .send_by_dma(Channel::<0>::new(), b"hello")
            .expect("5 bytes");
        assert_eq!(dma_destination(0).read(), 0x1F80_6220);
        let sizes = [dma_source_size(0), dma_destination_size(0), dma_cell_size(0)];
        assert_eq!(sizes.map(|size| size.read()), [5, 1, 1]);
        assert_eq!(dma_event(0).read(), 42 << 8 | 1 << 4 | 1 << 7);
        assert!(!Source::Uart2Sent.is_pending() && !Source::Uart2Sent.is_enabled());
        end_block(0, 1 << 3);
        let finished = sending.wait();
        assert_eq!((finished.moved, finished.buffer), (5, b"hello"));
        let error = finished
            .driver
            .send_by_dma(finished.channel, [1_u8; 257].as_slice());
        assert_eq!(error.expect_err("too long").bytes, 257);
    }

    #[test]
    fn receiving_reads_a_byte_for_each_request_and_tells_errors() {
        static LINE: StaticBuffer<u8, 16> = StaticBuffer::new([b'x'; 16]);
        let _alone = alone();
        let (_, receiver) = halves();
        let line = LINE.take().expect("the first time");
        let receiving = receiver
            .receive_by_dma(Channel::<1>::new(), line, Some(b'\n'))
            .expect("16 bytes");
        assert_eq!(dma_source(1).read(), 0x1F80_6230);
        let sizes = [dma_source_size(1), dma_destination_size(1), dma_cell_size(1)];
        assert_eq!(sizes.map(|size| size.read()), [1, 16, 1]);
        assert_eq!(dma_event(1).read(), 41 << 8 | 1 << 4 | 1 << 5);
        assert_eq!(dma_pattern(1).read(), u32::from(b'\n'));
        assert_eq!(dma_control(1).read() & 1 << 4, 0, "once");
        end_block(1, 1 << 3);
        Source::Uart2Error.request();
        let finished = receiving.wait();
        assert_eq!(
            (finished.moved, finished.outcome),
            (16, Err(TransferError::Peripheral))
        );
        assert!(Source::Uart2Error.is_pending(), "left for who wants to know");
    }

    #[test]
    fn a_ring_is_read_behind_the_channel_and_says_when_it_was_lapped() {
        static RING: StaticBuffer<u8, 4> = StaticBuffer::new(*b"abcd");
        let _alone = alone();
        let (_, receiver) = halves();
        let ring = RING.take().expect("the first time");
        let mut ring = receiver
            .receive_into_ring(Channel::<2>::new(), ring)
            .expect("4 bytes");
        assert_eq!(dma_control(2).read() & (1 << 4 | 1 << 7), 1 << 4 | 1 << 7);
        let mut bytes = [0; 8];
        assert_eq!(ring.read(&mut bytes), Ok(0));
        dma_destination_pointer(2).write(3);
        assert_eq!(ring.read(&mut bytes[..2]), Ok(2));
        assert_eq!(bytes[..2], *b"ab");
        // Round the end, to the second place.
        dma_destination_pointer(2).write(1);
        dma_interrupt(2).set(1 << 3);
        assert_eq!(ring.read(&mut bytes), Ok(3));
        assert_eq!(bytes[..3], *b"cda");
        assert_eq!(dma_interrupt(2).read() & 1 << 3, 0);
        // Round the end and beyond what was read last.
        dma_destination_pointer(2).write(2);
        dma_interrupt(2).set(1 << 3);
        assert_eq!(ring.read(&mut bytes), Err(RingError::Lapped));
        assert_eq!(ring.read(&mut bytes), Ok(0), "it goes on with what comes now");
        // A whole round, and not a byte more.
        dma_interrupt(2).set(1 << 3);
        assert_eq!(ring.read(&mut bytes), Ok(4));
        Source::Uart2Error.request();
        assert_eq!(ring.read(&mut bytes), Err(RingError::Line));
        assert_eq!(ring.read(&mut bytes), Ok(0));
        let (_, _, buffer) = ring.stop();
        assert_eq!(buffer, b"abcd");
        assert_eq!(dma_control(2).read() & (1 << 4 | 1 << 7), 0);
        dma_destination_pointer(2).write(0);
    }
}
