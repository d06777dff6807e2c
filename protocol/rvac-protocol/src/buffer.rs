//! Outgoing bytes: one report or command, sealed and separated.

use heapless::Vec;

/// Capacity of a [`PacketBuffer`]: an `info` report travels as three packets, each with its separator.
pub const PACKET_BUFFER_BYTES: usize = 576;

/// What is to be sent next: whole packets with their separators. Send all of it or none, so that two packets never melt.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PacketBuffer {
    bytes: Vec<u8, PACKET_BUFFER_BYTES>,
}

/// The packet did not fit into its buffer or its size limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLong;

impl PacketBuffer {
    /// An empty buffer.
    #[must_use]
    pub const fn new() -> Self {
        Self { bytes: Vec::new() }
    }

    /// The bytes for the line.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Forgets the content.
    pub fn clear(&mut self) {
        self.bytes.clear();
    }

    pub(crate) fn push(&mut self, byte: u8) -> Result<(), TooLong> {
        self.bytes.push(byte).map_err(|_| TooLong)
    }

    pub(crate) fn extend(&mut self, bytes: &[u8]) -> Result<(), TooLong> {
        self.bytes.extend_from_slice(bytes).map_err(|_| TooLong)
    }

    pub(crate) fn truncate(&mut self, length: usize) {
        self.bytes.truncate(length);
    }
}
