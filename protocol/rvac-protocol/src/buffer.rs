//! Outgoing bytes: one report or command with its CRC and separator.

use heapless::Vec;

use crate::crc::{Direction, packet_crc, to_hex};
use crate::frame::{PACKET_BYTES_MAX, SEPARATOR, SEPARATOR_2016, STUFFED_BIT, STUFFING, TEXT_CRC_BYTES};

/// Capacity of a [`PacketBuffer`]: an `info` report travels as three packets, each with its separator.
pub const PACKET_BUFFER_BYTES: usize = 576;

/// The bytes to send next: whole packets with their separators. Send all of them or none, so that two packets never
/// mix.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PacketBuffer {
    bytes: Vec<u8, PACKET_BUFFER_BYTES>,
}

/// A message cannot be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EncodeError {
    /// The packet does not fit its limit of 256 bytes.
    TooLong,
    /// A number is out of range.
    Range,
}

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

    /// Clears the content.
    pub fn clear(&mut self) {
        self.bytes.clear();
    }

    pub(crate) fn length(&self) -> usize {
        self.bytes.len()
    }

    pub(crate) fn push(&mut self, byte: u8) -> Result<(), EncodeError> {
        self.bytes.push(byte).map_err(|_| EncodeError::TooLong)
    }

    pub(crate) fn extend(&mut self, bytes: &[u8]) -> Result<(), EncodeError> {
        self.bytes
            .extend_from_slice(bytes)
            .map_err(|_| EncodeError::TooLong)
    }

    pub(crate) fn truncate(&mut self, length: usize) {
        self.bytes.truncate(length);
    }

    /// Appends the CRC of the text that begins at `start`, and a separator.
    pub(crate) fn append_crc(
        &mut self,
        start: usize,
        direction: Direction,
        session: u16,
    ) -> Result<(), EncodeError> {
        let text = self.bytes.get(start..).unwrap_or_default();
        if text.len() + TEXT_CRC_BYTES > PACKET_BYTES_MAX {
            return Err(EncodeError::TooLong);
        }
        let digits = to_hex(packet_crc(direction, session, text));
        self.push(b'*')?;
        self.extend(&digits)?;
        self.push(SEPARATOR)
    }

    /// Appends a binary packet: `packet` (kind and body) and its CRC, stuffed, and a separator.
    pub(crate) fn push_binary(
        &mut self,
        packet: &[u8],
        direction: Direction,
        session: u16,
    ) -> Result<(), EncodeError> {
        let crc = packet_crc(direction, session, packet).to_le_bytes();
        for byte in packet.iter().chain(&crc) {
            self.push_stuffed(*byte)?;
        }
        self.push(SEPARATOR)
    }

    fn push_stuffed(&mut self, byte: u8) -> Result<(), EncodeError> {
        if matches!(byte, STUFFING | SEPARATOR | SEPARATOR_2016) {
            self.push(STUFFING)?;
            self.push(byte ^ STUFFED_BIT)
        } else {
            self.push(byte)
        }
    }
}
