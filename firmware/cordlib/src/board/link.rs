//! Bytes to and from the host.

/// What the receiver hands over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Received {
    /// A byte that arrived well.
    Byte(u8),
    /// A byte whose stop bit was wrong.
    FramingError,
    /// At least one byte was lost because the receive queue was full.
    Overrun,
}

/// The serial link.
pub trait Link {
    /// The oldest event in the receive queue, or `None` when it is empty.
    fn receive(&mut self) -> Option<Received>;

    /// Hands bytes to the transmit queue and returns how many it took, from the front, 0 when it is full.
    fn transmit(&mut self, bytes: &[u8]) -> usize;
}
