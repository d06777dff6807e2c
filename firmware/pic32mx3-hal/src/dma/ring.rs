//! A ring that a UART's receiver fills and the program reads behind it.

use super::transfer::Plan;
use super::{Channel, Lent, WriteBuffer};
use crate::register::map::uart_status;
use crate::uart::{Receiver, Uart};
use core::fmt;
use core::sync::atomic::{Ordering, compiler_fence};

/// OERR.
const OVERRUN: u32 = 1 << 1;

/// Why bytes are missing or doubtful.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RingError {
    /// More bytes came than the ring has places: all that were in it are dropped.
    Lapped,
    /// The receiver saw an overrun, a framing or a parity error since the last reading. The bytes are still to be read.
    Line,
}

impl fmt::Display for RingError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Lapped => "bytes were lost because the ring was not read in time",
            Self::Line => "bytes were lost or misread on the line",
        })
    }
}

impl core::error::Error for RingError {}

/// A receiver that fills a ring for ever.
///
/// It notices a round that was missed only when it is read at least once a round: with 256 bytes at 115,200 baud, every 22 ms.
#[derive(Debug)]
pub struct RingReceiver<const NUMBER: u8, const UART: u8, P, B: WriteBuffer<Element = u8>> {
    channel: Channel<NUMBER>,
    receiver: Receiver<UART, P>,
    lent: Lent<u8>,
    buffer: core::marker::PhantomData<fn(B)>,
    /// The place that is read next.
    next: usize,
}

impl<const NUMBER: u8, const UART: u8, P, B: WriteBuffer<Element = u8>> RingReceiver<NUMBER, UART, P, B> {
    pub(super) fn begin(
        (mut channel, receiver): (Channel<NUMBER>, Receiver<UART, P>),
        lent: Lent<u8>,
        plan: &Plan,
    ) -> Self {
        channel.begin(plan);
        Self {
            channel,
            receiver,
            lent,
            buffer: core::marker::PhantomData,
            next: 0,
        }
    }

    /// Takes what came, as much as there is room for, and returns how many bytes those are. Bytes that there was no room for stay
    /// for the next call, but make the next round shorter.
    ///
    /// # Errors
    /// [`RingError`]
    pub fn read(&mut self, bytes: &mut [u8]) -> Result<usize, RingError> {
        let length = self.lent.len();
        let (is_round, written) = Self::position();
        // After the position: bytes that come with an error are not taken before it is told.
        if Uart::<UART>::ERROR.is_pending() {
            // Without that the receiver stops after an overrun.
            uart_status(UART).clear(OVERRUN);
            Uart::<UART>::ERROR.clear();
            return Err(RingError::Line);
        }
        // The channel's bytes are read after its pointer.
        compiler_fence(Ordering::SeqCst);
        let waiting = match (is_round, written.checked_sub(self.next)) {
            (false, Some(waiting)) => waiting,
            // It has gone round the end, up to the place that is read next at most.
            (true, Some(0)) => length,
            (true, None) => written + length - self.next,
            (true, Some(_)) | (false, None) => return Err(self.begin_anew()),
        };
        let count = waiting.min(bytes.len());
        for (step, byte) in bytes.iter_mut().take(count).enumerate() {
            *byte = self.lent.element((self.next + step) % length).unwrap_or_default();
        }
        // What came meanwhile must not have overtaken the reading.
        compiler_fence(Ordering::SeqCst);
        let (_, written_now) = Self::position();
        if waiting + (written_now + length - written) % length > length {
            return Err(self.begin_anew());
        }
        let after = self.next + count;
        // While what is left lies before the end, the round is not read yet.
        if is_round && after >= length {
            Channel::<NUMBER>::forget_block();
        }
        self.next = after % length;
        Ok(count)
    }

    /// With what comes from now on.
    fn begin_anew(&mut self) -> RingError {
        Channel::<NUMBER>::forget_block();
        self.next = Channel::<NUMBER>::pointers().1;
        RingError::Lapped
    }

    /// Whether the channel went round the end since that was forgotten, and the place that it writes next.
    fn position() -> (bool, usize) {
        loop {
            let is_round = Channel::<NUMBER>::is_block_done();
            let (_, written) = Channel::<NUMBER>::pointers();
            // Both from the same moment.
            if Channel::<NUMBER>::is_block_done() == is_round {
                return (is_round, written);
            }
        }
    }

    /// Stops it and gives the parts back. What came and was not read is in the buffer.
    #[must_use]
    pub fn stop(self) -> (Channel<NUMBER>, Receiver<UART, P>, B) {
        Channel::<NUMBER>::halt();
        Channel::<NUMBER>::acknowledge();
        // SAFETY: lent when it began, and the channel is off.
        let buffer = unsafe { B::reclaim(self.lent) };
        (self.channel, self.receiver, buffer)
    }
}
