//! Writing one JSON object into a packet.

use super::decimal::spell;
use crate::buffer::{EncodeError, PacketBuffer};
use crate::span::Span;

/// Appends the members of one object. An error is kept until the end, so that the code of a packet reads as a list of
/// members.
#[derive(Debug)]
pub(crate) struct ObjectWriter<'b> {
    buffer: &'b mut PacketBuffer,
    begin: usize,
    outcome: Result<(), EncodeError>,
}

impl<'b> ObjectWriter<'b> {
    pub(crate) fn new(buffer: &'b mut PacketBuffer) -> Self {
        let begin = buffer.length();
        Self {
            buffer,
            begin,
            outcome: Ok(()),
        }
    }

    /// A number, which must be in its span.
    pub(crate) fn number(&mut self, key: &str, value: impl Into<i64>, span: Span) -> &mut Self {
        let value = value.into();
        if !span.contains(value) {
            self.outcome = Err(EncodeError::Range);
        }
        self.key(key);
        self.raw(spell(value, span.decimals).as_bytes())
    }

    /// Notes that a number is not allowed.
    pub(crate) fn out_of_range(&mut self) -> &mut Self {
        self.outcome = Err(EncodeError::Range);
        self
    }

    /// A measured number; beyond its span it is clamped.
    pub(crate) fn measured(&mut self, key: &str, value: impl Into<i64>, span: Span) -> &mut Self {
        self.number(key, span.saturate(value.into()), span)
    }

    /// A name: text without escapes. A character that would need one is replaced by `?`.
    pub(crate) fn name(&mut self, key: &str, name: &str) -> &mut Self {
        self.key(key);
        self.raw(b"\"");
        for byte in name.bytes() {
            let plain = matches!(byte, b' '..=b'~') && byte != b'"' && byte != b'\\';
            self.raw(&[if plain { byte } else { b'?' }]);
        }
        self.raw(b"\"")
    }

    /// A text of two letters.
    pub(crate) fn letters(&mut self, key: &str, letters: [u8; 2]) -> &mut Self {
        self.key(key);
        self.raw(b"\"");
        self.raw(&letters);
        self.raw(b"\"")
    }

    /// Names separated by spaces.
    pub(crate) fn names<'n>(&mut self, key: &str, mut names: impl Iterator<Item = &'n str>) -> &mut Self {
        self.names_of(key, &mut names)
    }

    /// The same, once for all kinds of lists: the robot's flash is small.
    #[inline(never)]
    fn names_of(&mut self, key: &str, names: &mut dyn Iterator<Item = &str>) -> &mut Self {
        self.key(key);
        self.raw(b"\"");
        for (index, name) in names.enumerate() {
            if index > 0 {
                self.raw(b" ");
            }
            self.raw(name.as_bytes());
        }
        self.raw(b"\"")
    }

    /// Names separated by spaces, as many as leave `bytes_left` bytes in the packet.
    pub(crate) fn names_that_fit<'n>(
        &mut self,
        key: &str,
        names: impl Iterator<Item = &'n str>,
        bytes_left: usize,
    ) -> &mut Self {
        let mut room = self.room(bytes_left).saturating_sub(key.len() + 6);
        let fitting = names.take_while(|name| {
            let fits = name.len() < room;
            room = room.saturating_sub(name.len() + 1);
            fits
        });
        self.names(key, fitting)
    }

    /// Text for people, escaped, cut at a character when the packet is full.
    pub(crate) fn prose(&mut self, key: &str, text: &str) -> &mut Self {
        self.key(key);
        self.raw(b"\"");
        let mut room = self.room(2);
        for character in text.chars() {
            let escaped = Escaped::new(character);
            if escaped.bytes().len() > room {
                break;
            }
            room -= escaped.bytes().len();
            self.raw(escaped.bytes());
        }
        self.raw(b"\"")
    }

    /// A truth value.
    pub(crate) fn flag(&mut self, key: &str, flag: bool) -> &mut Self {
        self.key(key);
        self.raw(if flag { b"true" } else { b"false" })
    }

    /// `null`
    pub(crate) fn null(&mut self, key: &str) -> &mut Self {
        self.key(key);
        self.raw(b"null")
    }

    /// Text of hexadecimal bytes.
    pub(crate) fn hex(&mut self, key: &str, bytes: &[u8]) -> &mut Self {
        self.key(key);
        self.raw(b"\"");
        for byte in bytes {
            self.raw(&hex_digits(*byte));
        }
        self.raw(b"\"")
    }

    /// Text of numbers with spaces between them.
    pub(crate) fn numbers(&mut self, key: &str, numbers: &[u16]) -> &mut Self {
        self.key(key);
        self.raw(b"\"");
        for (index, number) in numbers.iter().enumerate() {
            if index > 0 {
                self.raw(b" ");
            }
            self.raw(spell(i64::from(*number), 0).as_bytes());
        }
        self.raw(b"\"")
    }

    /// Text of words of four hexadecimal digits with spaces between them.
    pub(crate) fn hex_words(&mut self, key: &str, words: &[u16]) -> &mut Self {
        self.key(key);
        self.raw(b"\"");
        for (index, word) in words.iter().enumerate() {
            if index > 0 {
                self.raw(b" ");
            }
            for byte in word.to_be_bytes() {
                self.raw(&hex_digits(byte));
            }
        }
        self.raw(b"\"")
    }

    /// Ends the object. After an error the buffer is as it was before the object.
    pub(crate) fn finish(&mut self) -> Result<(), EncodeError> {
        if self.buffer.length() == self.begin {
            self.raw(b"{");
        }
        self.raw(b"}");
        if self.outcome.is_err() {
            self.buffer.truncate(self.begin);
        }
        self.outcome
    }

    /// Free bytes of the packet, less its CRC and `bytes_left`.
    fn room(&self, bytes_left: usize) -> usize {
        let used = self.buffer.length() - self.begin;
        (crate::frame::PACKET_BYTES_MAX - crate::frame::TEXT_CRC_BYTES).saturating_sub(used + bytes_left)
    }

    fn key(&mut self, key: &str) {
        let first = self.buffer.length() == self.begin;
        self.raw(if first { b"{\"" } else { b",\"" });
        self.raw(key.as_bytes());
        self.raw(b"\":");
    }

    fn raw(&mut self, bytes: &[u8]) -> &mut Self {
        if self.outcome.is_ok() {
            self.outcome = self.buffer.extend(bytes);
        }
        self
    }
}

const fn hex_digits(byte: u8) -> [u8; 2] {
    const DIGITS: &[u8; 16] = b"0123456789abcdef";
    [DIGITS[(byte >> 4) as usize], DIGITS[(byte & 0xF) as usize]]
}

/// One character in its JSON spelling.
struct Escaped {
    bytes: [u8; 6],
    length: usize,
}

impl Escaped {
    fn new(character: char) -> Self {
        let mut bytes = [0; 6];
        let length = match character {
            '"' | '\\' => {
                bytes = [b'\\', character as u8, 0, 0, 0, 0];
                2
            }
            '\0'..'\u{20}' => {
                let code = character as u8;
                let low = match code & 0xF {
                    digit @ 0..=9 => b'0' + digit,
                    digit => b'a' + digit - 10,
                };
                bytes = [b'\\', b'u', b'0', b'0', b'0' + (code >> 4), low];
                6
            }
            _ => character.encode_utf8(&mut bytes).len(),
        };
        Self { bytes, length }
    }

    fn bytes(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or_default()
    }
}
