//! From bytes to packets.
//!
//! A *separator* (0x1F, or 0x1E from tools of 2016) ends a packet. A *poisoned* packet is one that cannot be whole any
//! more: a forbidden control byte, a framing error, too many bytes; everything up to the next separator is dropped with
//! it. Work per byte is bounded: the digest follows some bytes behind the input, because the last bytes of a packet are
//! its CRC, and nobody knows that they are the last until the separator comes.
//!
//! Most bytes are *plain*: inside of a packet, nothing to do but to keep them. They take the short way through
//! [`Framer::push`]; every sixteenth takes the long way and brings the digest on.

use crate::crc::{Digest, Direction, from_hex};

/// Most bytes of a packet, its CRC included, its separator not. Binary packets are counted unstuffed.
pub const PACKET_BYTES_MAX: usize = 256;
/// Ends a packet: Unit Separator.
pub const SEPARATOR: u8 = 0x1F;
/// Ends a packet too, on receive: Record Separator, which the software published in 2016 sent.
pub const SEPARATOR_2016: u8 = 0x1E;
/// In a binary packet: the next byte was combined with [`STUFFED_BIT`].
pub const STUFFING: u8 = 0x1D;
/// What a stuffed byte is combined with (exclusive or).
pub const STUFFED_BIT: u8 = 0x20;
/// First value of the kind byte of a binary packet.
pub const BINARY_KIND_MIN: u8 = 0x80;

/// `*` and eight digits.
pub(crate) const TEXT_CRC_BYTES: usize = 9;
/// The CRC of a binary packet, little endian.
const BINARY_CRC_BYTES: usize = 4;
/// Bytes that the digest takes at a time.
const DIGEST_STEP: usize = 16;
/// The first byte that is never special inside of a packet.
const PLAIN_FROM: u8 = 0x20;

/// What a separator ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Framed<'a> {
    /// Text without a CRC.
    Unchecked(&'a [u8]),
    /// Text with the right CRC, which is cut off.
    Checked(&'a [u8]),
    /// Text whose CRC is not that of the session.
    BadCrc {
        /// The text without the CRC.
        text: &'a [u8],
        /// The CRC it came with.
        crc: u32,
    },
    /// A binary packet with the right CRC.
    Binary {
        /// What it is, 0x80 or above.
        kind: u8,
        /// Unstuffed, without kind and CRC.
        body: &'a [u8],
    },
    /// A binary packet with a wrong CRC or too short for one.
    BinaryBadCrc,
    /// A poisoned packet.
    Poisoned(Poison),
}

/// Why a packet is dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Poison {
    /// More than [`PACKET_BYTES_MAX`] bytes.
    TooLong,
    /// A byte below 0x20 in a text, or a broken stuffing in a binary packet.
    ControlByte,
    /// The receiver saw a wrong stop bit.
    FramingError,
    /// The receiver lost bytes.
    Overrun,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PacketForm {
    Text,
    Binary,
    BinaryStuffing,
    Poisoned(Poison),
}

/// Splits a stream into packets and checks their CRCs.
#[derive(Clone, Debug)]
pub struct Framer {
    buffer: [u8; PACKET_BYTES_MAX],
    length: usize,
    digested: usize,
    /// The length up to which plain bytes are only stored; 0 where every byte must be examined.
    plain_until: usize,
    /// Bytes below this are plain, besides those from [`PLAIN_FROM`] on: none in a text, all but the three special ones
    /// in a binary packet.
    plain_below: u8,
    digest: Digest,
    start: Digest,
    direction: Direction,
    form: PacketForm,
}

impl Framer {
    /// A framer for packets that travel in `direction`, before any session.
    #[must_use]
    pub fn new(direction: Direction) -> Self {
        let start = Digest::start(direction, 0);
        Self {
            buffer: [0; PACKET_BYTES_MAX],
            length: 0,
            digested: 0,
            plain_until: 0,
            plain_below: 0,
            digest: start,
            start,
            direction,
            form: PacketForm::Text,
        }
    }

    /// CRCs are those of `session` from the next packet on; a packet that has begun is still checked with the old
    /// session.
    pub fn set_session(&mut self, session: u16) {
        self.start = Digest::start(self.direction, session);
        if self.length == 0 {
            self.digest = self.start;
        }
    }

    /// Takes one byte. A separator returns the packet that it ends; empty packets return nothing.
    #[inline]
    pub fn push(&mut self, byte: u8) -> Option<Framed<'_>> {
        let plain = byte >= PLAIN_FROM || byte < self.plain_below;
        if plain
            && self.length < self.plain_until
            && let Some(slot) = self.buffer.get_mut(self.length)
        {
            *slot = byte;
            self.length += 1;
            return None;
        }
        self.push_special(byte)
    }

    fn push_special(&mut self, byte: u8) -> Option<Framed<'_>> {
        if byte == SEPARATOR || byte == SEPARATOR_2016 {
            return self.finish();
        }
        match self.form {
            PacketForm::Text if self.length == 0 && byte >= BINARY_KIND_MIN => {
                self.form = PacketForm::Binary;
                self.plain_below = STUFFING;
                self.take(byte);
            }
            PacketForm::Text if byte < PLAIN_FROM => self.poison(Poison::ControlByte),
            PacketForm::Binary if byte == STUFFING => {
                self.form = PacketForm::BinaryStuffing;
                self.plain_until = 0;
            }
            PacketForm::Text | PacketForm::Binary => self.take(byte),
            PacketForm::BinaryStuffing => self.unstuff(byte),
            PacketForm::Poisoned(_) => {}
        }
        None
    }

    /// Drops everything up to the next separator.
    pub fn poison(&mut self, poison: Poison) {
        if !matches!(self.form, PacketForm::Poisoned(_)) {
            self.form = PacketForm::Poisoned(poison);
            self.plain_until = 0;
        }
    }

    /// Whether a packet has begun.
    #[must_use]
    pub fn is_inside_packet(&self) -> bool {
        self.length != 0 || self.form != PacketForm::Text
    }

    fn unstuff(&mut self, byte: u8) {
        let original = byte ^ STUFFED_BIT;
        if matches!(original, STUFFING | SEPARATOR | SEPARATOR_2016) {
            self.form = PacketForm::Binary;
            self.take(original);
        } else {
            self.poison(Poison::ControlByte);
        }
    }

    /// Stores a byte and advances the digest when the next step cannot be part of the CRC.
    fn take(&mut self, byte: u8) {
        let Some(slot) = self.buffer.get_mut(self.length) else {
            self.poison(Poison::TooLong);
            return;
        };
        *slot = byte;
        self.length += 1;
        let crc_bytes = if self.form == PacketForm::Binary {
            BINARY_CRC_BYTES
        } else {
            TEXT_CRC_BYTES
        };
        let step_end = self.digested + DIGEST_STEP;
        if self.length >= step_end + crc_bytes {
            self.catch_up(step_end);
        }
        self.plain_until = self.digested + DIGEST_STEP + crc_bytes - 1;
    }

    /// Takes the bytes up to `end` into the digest.
    #[inline]
    fn catch_up(&mut self, end: usize) {
        if let Some(bytes) = self.buffer.get(self.digested..end) {
            self.digest.extend(bytes);
            self.digested = end;
        }
    }

    fn finish(&mut self) -> Option<Framed<'_>> {
        let form = self.form;
        let length = self.length;
        match form {
            PacketForm::Text if length == 0 => None,
            PacketForm::Text => Some(self.finish_text(length)),
            PacketForm::Binary => Some(self.finish_binary(length)),
            PacketForm::BinaryStuffing => {
                self.restart();
                Some(Framed::Poisoned(Poison::ControlByte))
            }
            PacketForm::Poisoned(poison) => {
                self.restart();
                Some(Framed::Poisoned(poison))
            }
        }
    }

    fn finish_text(&mut self, length: usize) -> Framed<'_> {
        let crc = self.text_crc(length);
        let text_length = if crc.is_some() {
            length - TEXT_CRC_BYTES
        } else {
            length
        };
        if crc.is_some() {
            self.catch_up(text_length);
        }
        let right = self.digest.crc();
        self.restart();
        let text = self.buffer.get(..text_length).unwrap_or_default();
        match crc {
            None => Framed::Unchecked(text),
            Some(crc) if crc == right => Framed::Checked(text),
            Some(crc) => Framed::BadCrc { text, crc },
        }
    }

    fn finish_binary(&mut self, length: usize) -> Framed<'_> {
        let body_end = length.saturating_sub(BINARY_CRC_BYTES);
        self.catch_up(body_end);
        let right = self.digest.crc();
        self.restart();
        let packet = self.buffer.get(..body_end).unwrap_or_default();
        let crc = self.buffer.get(body_end..length).unwrap_or_default();
        match packet {
            [kind, body @ ..] if crc == right.to_le_bytes() => Framed::Binary { kind: *kind, body },
            _ => Framed::BinaryBadCrc,
        }
    }

    fn text_crc(&self, length: usize) -> Option<u32> {
        let tail = self.buffer.get(..length)?.last_chunk::<TEXT_CRC_BYTES>()?;
        match tail {
            [b'*', digits @ ..] => from_hex(*digits),
            _ => None,
        }
    }

    fn restart(&mut self) {
        self.length = 0;
        self.digested = 0;
        self.plain_until = 0;
        self.plain_below = 0;
        self.digest = self.start;
        self.form = PacketForm::Text;
    }
}
