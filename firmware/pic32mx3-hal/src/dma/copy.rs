//! Memory to memory.

use super::transfer::{Driver, LengthError, Plan, Side, Start, Transfer, sealed};
use super::{Channel, Lent, ReadBuffer, WriteBuffer};

/// Memory that a channel reads while it writes other memory.
#[derive(Debug)]
pub struct Reading<R: ReadBuffer>(Lent<R::Element>);

impl<R: ReadBuffer> Reading<R> {
    /// The memory. Nothing reads it any more: this comes out of a transfer that is over.
    #[must_use]
    pub fn into_inner(self) -> R {
        // SAFETY: it was lent when the transfer began, and whoever has this by value has it from a channel that is off.
        unsafe { R::reclaim(self.0) }
    }
}

impl<R: ReadBuffer> sealed::Sealed for Reading<R> {}
impl<R: ReadBuffer> Driver for Reading<R> {
    fn has_failed(&self) -> bool {
        false
    }

    fn end(&mut self) {}
}

/// A channel that copies.
pub type Copying<const NUMBER: u8, R, B> = Transfer<NUMBER, Reading<R>, B>;

impl<const NUMBER: u8> Channel<NUMBER> {
    /// Copies `from` to `to` in one go. A shorter `from` is repeated, so that one element fills all of `to`; what is left over in the
    /// last round is cut off.
    ///
    /// # Errors
    /// [`LengthError`] when `from` is empty or longer than `to`, or `to` has more than 256 bytes.
    pub fn copy<R, B>(self, from: R, to: B) -> Result<Copying<NUMBER, R, B>, LengthError<(Self, R, B)>>
    where
        R: ReadBuffer,
        B: WriteBuffer<Element = R::Element>,
    {
        self.copy_as(from, to, None)
    }

    /// Copies bytes until one of them is `last`, which is copied, too: a text with its final zero.
    ///
    /// # Errors
    /// As for [`Self::copy`].
    pub fn copy_until<R, B>(
        self,
        from: R,
        to: B,
        last: u8,
    ) -> Result<Copying<NUMBER, R, B>, LengthError<(Self, R, B)>>
    where
        R: ReadBuffer<Element = u8>,
        B: WriteBuffer<Element = u8>,
    {
        self.copy_as(from, to, Some(last))
    }

    fn copy_as<R, B>(
        self,
        from: R,
        to: B,
        until: Option<u8>,
    ) -> Result<Copying<NUMBER, R, B>, LengthError<(Self, R, B)>>
    where
        R: ReadBuffer,
        B: WriteBuffer<Element = R::Element>,
    {
        let (from, to) = (from.lend(), to.lend());
        let (read, written) = (from.bytes(), to.bytes());
        let fits = (1..=written).contains(&read);
        let bytes = if fits { written } else { read };
        // A `from` that does not fit is refused whatever its length.
        let checked = match fits {
            true => LengthError::check(bytes, (self, from, to)),
            false => Err(LengthError {
                bytes,
                parts: (self, from, to),
            }),
        };
        let (channel, from, to) = checked.map_err(|error| {
            let (channel, from, to) = error.parts;
            LengthError {
                bytes: error.bytes,
                // SAFETY: lent above, and no channel was started.
                parts: unsafe { (channel, R::reclaim(from), B::reclaim(to)) },
            }
        })?;
        let plan = Plan {
            source: Side::of(&from),
            destination: Side::of(&to),
            cell_bytes: written,
            start: Start::Program,
            until,
            repeats: false,
        };
        Ok(Transfer::begin((channel, Reading(from)), to, &plan))
    }
}

#[cfg(test)]
mod tests {
    use crate::dma::tests::{alone, end_block};
    use crate::dma::{Channel, StaticBuffer, TransferError};
    use crate::register::map::{
        dma_cell_size, dma_control, dma_destination, dma_destination_pointer, dma_destination_size,
        dma_event, dma_interrupt, dma_pattern, dma_source, dma_source_size,
    };

    fn physical<T>(memory: &T) -> u32 {
        core::ptr::from_ref(memory).addr() as u32 & 0x1FFF_FFFF
    }

    #[test]
    fn a_copy_sets_each_register() {
        static TO: StaticBuffer<u16, 128> = StaticBuffer::new([0; 128]);
        static FROM: [u16; 128] = [7; 128];
        let _alone = alone();
        let to = TO.take().expect("the first time");
        let places = (physical(&FROM), physical(to));
        let mut channel = Channel::<1>::new();
        channel.set_priority(crate::dma::ChannelPriority::High);
        let copying = channel.copy(&FROM, to).expect("256 bytes");
        assert_eq!((dma_source(1).read(), dma_destination(1).read()), places);
        let sizes = [dma_source_size(1), dma_destination_size(1), dma_cell_size(1)];
        assert_eq!(sizes.map(|size| size.read()), [0, 0, 0], "0 is 256");
        assert_eq!(dma_control(1).read(), 1 << 7 | 2);
        assert_eq!(dma_event(1).read(), 1 << 7, "forced");
        assert_eq!(dma_interrupt(1).read(), 0b1011 << 16);
        dma_destination_pointer(1).write(100);
        assert!(!copying.is_over());
        assert_eq!(copying.progress(), 50);
        let copying = copying.try_finish().expect_err("it is under way");
        end_block(1, 1 << 3 | 1 << 2);
        let finished = copying.try_finish().expect("it is over");
        assert_eq!((finished.moved, finished.outcome), (128, Ok(())));
        assert_eq!(finished.driver.into_inner(), &FROM);
        dma_destination_pointer(1).write(0);
        dma_control(1).write(0);
    }

    #[test]
    fn what_was_stopped_or_went_wrong_says_how_far_it_came() {
        static TO: StaticBuffer<u8, 8> = StaticBuffer::new([0; 8]);
        let _alone = alone();
        let to = TO.take().expect("the first time");
        let copying = Channel::<2>::new().copy(&[9_u8; 8], to).expect("8 bytes");
        dma_destination_pointer(2).write(5);
        let stopped = copying.stop();
        assert_eq!((stopped.moved, stopped.outcome), (5, Ok(())));
        assert_eq!(dma_control(2).read() & 1 << 7, 0);
        for (flag, error) in [(1, TransferError::Address), (2, TransferError::Aborted)] {
            let to: &'static mut [u8] = std::boxed::Box::leak(std::boxed::Box::new([0; 4]));
            let copying = Channel::<2>::new().copy(&[9_u8; 4], to).expect("4 bytes");
            dma_destination_pointer(2).write(0);
            end_block(2, flag);
            let finished = copying.wait();
            assert_eq!((finished.moved, finished.outcome), (0, Err(error)));
        }
    }

    #[test]
    fn a_byte_that_ends_a_copy_is_the_last_one() {
        static TO: StaticBuffer<u8, 8> = StaticBuffer::new(*b"ABC\0DEFG");
        let _alone = alone();
        let to = TO.take().expect("the first time");
        let copying = Channel::<0>::new()
            .copy_until(b"ABCDEFGH", to, 0)
            .expect("8 bytes");
        assert_eq!((dma_pattern(0).read(), dma_event(0).read() & 1 << 5), (0, 1 << 5));
        end_block(0, 1 << 3);
        assert_eq!(copying.wait().moved, 4);
    }

    #[test]
    fn lengths_that_do_not_fit_give_everything_back() {
        let _alone = alone();
        let leak = |length: usize| -> &'static mut [u8] { std::vec![0; length].leak() };
        for (from, to, bytes) in [
            (0, 4, 0),
            (5, 4, 5),
            (1, 257, 257),
            (257, 300, 300),
            (300, 4, 300),
        ] {
            let error = Channel::<3>::new()
                .copy(leak(from), leak(to))
                .expect_err("it does not fit");
            assert_eq!(error.bytes, bytes, "{from} to {to}");
            assert_eq!((error.parts.1.len(), error.parts.2.len()), (from, to));
            assert_eq!(dma_control(3).read() & 1 << 7, 0, "nothing was started");
        }
        let copying = Channel::<3>::new()
            .copy(leak(1), leak(256))
            .expect("one byte fills all");
        assert_eq!(
            (dma_source_size(3).read(), dma_destination_size(3).read()),
            (1, 0)
        );
        let _ = copying.stop();
    }
}
