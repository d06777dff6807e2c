//! A channel at work.

use super::{
    ABORT, ABORT_BY_SOURCE, ABORT_SHIFT, AUTO_ENABLE, BLOCK_BYTES_MAX, Channel, ENABLE, Element, FORCE, Lent,
    PRIORITY, ReadBuffer, START_BY_SOURCE, START_SHIFT, STOP_AT_PATTERN,
};
use crate::interrupt::Source;
use crate::register::map::{
    dma_cell_size, dma_control, dma_destination, dma_destination_pointer, dma_destination_size, dma_event,
    dma_interrupt, dma_pattern, dma_source, dma_source_pointer, dma_source_size,
};
use core::fmt;
use core::sync::atomic::{Ordering, compiler_fence};

/// Flags of DCHxINT; their enables are 16 bits higher.
const ADDRESS_ERROR: u32 = 1 << 0;
const ABORTED: u32 = 1 << 1;
pub(super) const BLOCK_DONE: u32 = 1 << 3;
const FLAGS: u32 = 0xFF;
const ENABLES: u32 = (ADDRESS_ERROR | ABORTED | BLOCK_DONE) << 16;

/// Why a block was not moved as it should have been.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransferError {
    /// There is no memory where the channel was to read or write.
    Address,
    /// A request of the source of [`Channel::set_abort`] ended it. The chip forgets how much was moved.
    Aborted,
    /// The peripheral complained meanwhile: a UART's receiver of an overrun, a framing or parity error, an SPI of an overrun. What was moved may be wrong or
    /// incomplete.
    Peripheral,
}

impl fmt::Display for TransferError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Address => "there is no memory where the channel was to read or write",
            Self::Aborted => "another request ended the transfer",
            Self::Peripheral => "the peripheral lost or misread something meanwhile",
        })
    }
}

impl core::error::Error for TransferError {}

/// A buffer that a block cannot move: blocks have 1 to 256 bytes, and both sides must fit each other.
#[derive(Debug)]
pub struct LengthError<T> {
    /// Bytes of the buffer.
    pub bytes: usize,
    /// What was given, unchanged.
    pub parts: T,
}

impl<T> LengthError<T> {
    /// The parts again when a block cannot have so many bytes.
    pub(super) fn check(bytes: usize, parts: T) -> Result<T, Self> {
        if (1..=BLOCK_BYTES_MAX).contains(&bytes) {
            Ok(parts)
        } else {
            Err(Self { bytes, parts })
        }
    }
}

impl<T> fmt::Display for LengthError<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bytes = self.bytes;
        write!(
            formatter,
            "one block cannot move {bytes} bytes: it has 1 to {BLOCK_BYTES_MAX}, and both sides must fit"
        )
    }
}

impl<T: fmt::Debug> core::error::Error for LengthError<T> {}

/// What a channel works for.
pub trait Driver: sealed::Sealed {
    /// Whether it complained since it began.
    #[doc(hidden)]
    fn has_failed(&self) -> bool;
    /// The channel does not work for it any more.
    #[doc(hidden)]
    fn end(&mut self);
}

pub(super) mod sealed {
    pub trait Sealed {}
}

/// One side of a transfer, as the chip wants it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Side {
    pub(super) address: u32,
    pub(super) bytes: usize,
}

impl Side {
    pub(super) fn of<W: Element>(lent: &Lent<W>) -> Self {
        Self {
            address: lent.physical_address(),
            bytes: lent.bytes(),
        }
    }
}

/// What starts the cells of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Start {
    /// The program, once; the whole block is one cell.
    Program,
    /// Each request of a source.
    Each(Source),
    /// Each request of a source that may have been made already: the program starts the first cell.
    EachAndNow(Source),
}

/// What a channel is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Plan {
    pub(super) source: Side,
    pub(super) destination: Side,
    pub(super) cell_bytes: usize,
    pub(super) start: Start,
    /// The byte that ends it.
    pub(super) until: Option<u8>,
    /// Whether it begins again and again.
    pub(super) repeats: bool,
}

/// Sizes have eight bits, and 0 stands for 256.
const fn size(bytes: usize) -> u32 {
    bytes as u32 & 0xFF
}

impl<const NUMBER: u8> Channel<NUMBER> {
    /// Starts it: the order of section 3.2.
    pub(super) fn begin(&mut self, plan: &Plan) {
        dma_control(NUMBER).clear(ENABLE);
        dma_interrupt(NUMBER).write(ENABLES);
        Self::SOURCE.clear();
        dma_source(NUMBER).write(plan.source.address);
        dma_destination(NUMBER).write(plan.destination.address);
        dma_source_size(NUMBER).write(size(plan.source.bytes));
        dma_destination_size(NUMBER).write(size(plan.destination.bytes));
        dma_cell_size(NUMBER).write(size(plan.cell_bytes));
        let abort = dma_event(NUMBER).read() & (0xFF << ABORT_SHIFT | ABORT_BY_SOURCE);
        let (start, forced) = match plan.start {
            Start::Program => (0, true),
            Start::Each(source) => (source as u32, false),
            Start::EachAndNow(source) => (source as u32, true),
        };
        let starts = if plan.start == Start::Program {
            0
        } else {
            START_BY_SOURCE
        };
        let pattern = match plan.until {
            Some(byte) => {
                dma_pattern(NUMBER).write(u32::from(byte));
                STOP_AT_PATTERN
            }
            None => 0,
        };
        dma_event(NUMBER).write(abort | start << START_SHIFT | starts | pattern);
        let repeats = if plan.repeats { AUTO_ENABLE } else { 0 };
        let priority = dma_control(NUMBER).read() & PRIORITY;
        dma_control(NUMBER).write(priority | repeats);
        // What the program has put into the memory is there before the channel reads it.
        compiler_fence(Ordering::SeqCst);
        dma_control(NUMBER).set(ENABLE);
        if forced {
            dma_event(NUMBER).set(FORCE);
        }
    }

    pub(super) fn is_running() -> bool {
        dma_control(NUMBER).has(ENABLE)
    }

    /// Bytes of the block that were read and written up to now.
    pub(super) fn pointers() -> (usize, usize) {
        let pointers = (dma_source_pointer(NUMBER), dma_destination_pointer(NUMBER));
        (pointers.0.read() as usize, pointers.1.read() as usize)
    }

    /// Ends it, whatever it does, and gives its pointers of before. It does not touch the memory after this.
    pub(super) fn halt() -> (usize, usize) {
        dma_control(NUMBER).clear(ENABLE | AUTO_ENABLE);
        // An access that was under way may still move them.
        let mut pointers = Self::pointers();
        loop {
            let again = Self::pointers();
            if again == pointers {
                break;
            }
            pointers = again;
        }
        dma_event(NUMBER).set(ABORT);
        while Self::is_running() {}
        dma_event(NUMBER).clear(ABORT | START_BY_SOURCE | STOP_AT_PATTERN);
        compiler_fence(Ordering::SeqCst);
        pointers
    }

    /// What the channel says about its block.
    pub(super) fn outcome() -> Result<(), TransferError> {
        match dma_interrupt(NUMBER).read() & FLAGS {
            flags if flags & ADDRESS_ERROR != 0 => Err(TransferError::Address),
            flags if flags & ABORTED != 0 => Err(TransferError::Aborted),
            _ => Ok(()),
        }
    }

    pub(super) fn is_block_done() -> bool {
        dma_interrupt(NUMBER).has(BLOCK_DONE)
    }

    pub(super) fn forget_block() {
        dma_interrupt(NUMBER).clear(BLOCK_DONE);
    }

    /// Takes the request of an interrupt back, for the handler of [`Self::SOURCE`]. What the channel says about its block stays.
    pub fn acknowledge() {
        dma_interrupt(NUMBER).clear(ENABLES);
        Self::SOURCE.clear();
    }
}

/// Which side of a transfer the buffer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BufferSide {
    Source,
    Destination,
}

/// A channel at work, with the buffer and the driver that it works for. When this is dropped or forgotten, the channel goes on,
/// in memory that nobody else has.
#[derive(Debug)]
#[must_use = "buffer, driver and channel come back by `wait`, `try_finish` or `stop`"]
pub struct Transfer<const NUMBER: u8, D: Driver, B: ReadBuffer> {
    channel: Channel<NUMBER>,
    driver: D,
    lent: Lent<B::Element>,
    side: BufferSide,
    until: Option<u8>,
}

/// What comes of a transfer.
#[derive(Debug)]
pub struct Finished<const NUMBER: u8, D, B> {
    /// The channel.
    pub channel: Channel<NUMBER>,
    /// The driver.
    pub driver: D,
    /// The buffer.
    pub buffer: B,
    /// Elements of the buffer that were read or written.
    pub moved: usize,
    /// Whether something went wrong.
    pub outcome: Result<(), TransferError>,
}

impl<const NUMBER: u8, D: Driver, B: ReadBuffer> Transfer<NUMBER, D, B> {
    pub(super) fn begin(
        (mut channel, driver): (Channel<NUMBER>, D),
        lent: Lent<B::Element>,
        plan: &Plan,
    ) -> Self {
        let side = match plan.source == Side::of(&lent) {
            true => BufferSide::Source,
            false => BufferSide::Destination,
        };
        channel.begin(plan);
        Self {
            channel,
            driver,
            lent,
            side,
            until: plan.until,
        }
    }

    /// Whether the block is over, well or not.
    #[must_use]
    pub fn is_over(&self) -> bool {
        !Channel::<NUMBER>::is_running()
    }

    /// Elements of the buffer that were read or written up to now; 0 when the block is over.
    #[must_use]
    pub fn progress(&self) -> usize {
        self.elements(Channel::<NUMBER>::pointers())
    }

    pub(super) fn driver_mut(&mut self) -> &mut D {
        &mut self.driver
    }

    fn elements(&self, (read, written): (usize, usize)) -> usize {
        let bytes = match self.side {
            BufferSide::Source => read,
            BufferSide::Destination => written,
        };
        bytes / size_of::<B::Element>()
    }

    /// What there is when the block is over, or the same again.
    ///
    /// # Errors
    /// The transfer itself, which is still under way.
    pub fn try_finish(self) -> Result<Finished<NUMBER, D, B>, Self> {
        if self.is_over() {
            Ok(self.stop())
        } else {
            Err(self)
        }
    }

    /// Waits for the end of the block. A peripheral that does not ask for service lets this wait for ever; see
    /// [`Channel::set_abort`].
    pub fn wait(self) -> Finished<NUMBER, D, B> {
        while !self.is_over() {}
        self.stop()
    }

    /// Ends it now.
    pub fn stop(mut self) -> Finished<NUMBER, D, B> {
        // Before this ends it, which the chip calls an abort, too.
        let said = Channel::<NUMBER>::outcome();
        let pointers = Channel::<NUMBER>::halt();
        let is_complete = Channel::<NUMBER>::is_block_done();
        Channel::<NUMBER>::acknowledge();
        self.driver.end();
        let outcome = match said {
            Ok(()) if self.driver.has_failed() => Err(TransferError::Peripheral),
            said => said,
        };
        let moved = match is_complete {
            true => self.length_of_block(),
            false => self.elements(pointers),
        };
        // SAFETY: it was lent when the transfer began, and the channel is off.
        let buffer = unsafe { B::reclaim(self.lent) };
        Finished {
            channel: self.channel,
            driver: self.driver,
            buffer,
            moved,
            outcome,
        }
    }

    /// Elements of a block that is over. Where a byte ended it the chip does not say, so that is looked for: the first such byte
    /// is the one, since all before it were written in this block.
    fn length_of_block(&self) -> usize {
        let length = self.lent.len();
        let Some(until) = self.until else { return length };
        let found = (0..length).find(|&index| {
            self.lent
                .element(index)
                .is_some_and(|element| element.to_byte() == Some(until))
        });
        found.map_or(length, |index| index + 1)
    }
}
