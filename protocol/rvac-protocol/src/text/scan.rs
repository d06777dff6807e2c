//! JSON, member by member, without a table of tokens and without recursion.

use super::decimal::Decimal;
use crate::message::Refusal;
use crate::span::Span;

/// A value of a member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value<'a> {
    /// The text between the quotes, escapes not decoded. No name of the wire has an escape, so names compare directly.
    Text(&'a [u8]),
    Number(Decimal),
    Flag(bool),
    Null,
    /// An array or an object: no packet of this version has one, those of newer versions may.
    Composite,
}

impl<'a> Value<'a> {
    pub(crate) fn number(self, span: Span) -> Result<i64, Refusal> {
        match self {
            Self::Number(number) => number.within(span).ok_or(Refusal::Range),
            _ => Err(Refusal::Syntax),
        }
    }

    pub(crate) fn text(self) -> Result<&'a [u8], Refusal> {
        match self {
            Self::Text(text) => Ok(text),
            _ => Err(Refusal::Syntax),
        }
    }

    pub(crate) fn flag(self) -> Result<bool, Refusal> {
        match self {
            Self::Flag(flag) => Ok(flag),
            _ => Err(Refusal::Syntax),
        }
    }
}

/// Reads the members of one object from left to right.
#[derive(Clone, Debug)]
pub(crate) struct Members<'a> {
    bytes: &'a [u8],
    at: usize,
    begun: bool,
}

/// Deepest nesting of unknown values.
const DEPTH_MAX: u32 = 32;

impl<'a> Members<'a> {
    /// Begins to read `text`, which must be UTF-8 and one JSON object.
    pub(crate) fn of(text: &'a [u8]) -> Result<Self, Refusal> {
        core::str::from_utf8(text).map_err(|_| Refusal::Syntax)?;
        let mut members = Self {
            bytes: text,
            at: 0,
            begun: false,
        };
        members.expect(b'{')?;
        Ok(members)
    }

    /// The next member; `None` after the last, when nothing but spaces follows the object.
    pub(crate) fn next(&mut self) -> Result<Option<(&'a [u8], Value<'a>)>, Refusal> {
        let first = !self.begun;
        self.begun = true;
        match self.token()? {
            b'}' => return self.end(),
            b',' if !first => self.expect(b'"')?,
            b'"' if first => {}
            _ => return Err(Refusal::Syntax),
        }
        let key = self.string()?;
        self.expect(b':')?;
        Ok(Some((key, self.value()?)))
    }

    fn end(&mut self) -> Result<Option<(&'a [u8], Value<'a>)>, Refusal> {
        self.skip_spaces();
        if self.at == self.bytes.len() {
            Ok(None)
        } else {
            Err(Refusal::Syntax)
        }
    }

    fn value(&mut self) -> Result<Value<'a>, Refusal> {
        self.skip_spaces();
        match self.peek() {
            Some(b'{' | b'[') => self.skip_composite(),
            Some(_) => self.scalar(),
            None => Err(Refusal::Syntax),
        }
    }

    fn scalar(&mut self) -> Result<Value<'a>, Refusal> {
        match self.peek() {
            Some(b'"') => {
                self.at += 1;
                self.string().map(Value::Text)
            }
            Some(b't') => self.literal(b"true", Value::Flag(true)),
            Some(b'f') => self.literal(b"false", Value::Flag(false)),
            Some(b'n') => self.literal(b"null", Value::Null),
            _ => {
                let rest = self.bytes.get(self.at..).unwrap_or_default();
                let (number, length) = Decimal::read(rest).ok_or(Refusal::Syntax)?;
                self.at += length;
                Ok(Value::Number(number))
            }
        }
    }

    fn literal(&mut self, word: &[u8], value: Value<'a>) -> Result<Value<'a>, Refusal> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        if rest.starts_with(word) {
            self.at += word.len();
            Ok(value)
        } else {
            Err(Refusal::Syntax)
        }
    }

    /// The rest of a string after its opening quote.
    #[inline]
    fn string(&mut self) -> Result<&'a [u8], Refusal> {
        let begin = self.at;
        loop {
            let byte = self.peek().ok_or(Refusal::Syntax)?;
            self.at += 1;
            match byte {
                b'"' => return Ok(self.bytes.get(begin..self.at - 1).unwrap_or_default()),
                b'\\' => self.escape()?,
                0..0x20 => return Err(Refusal::Syntax),
                _ => {}
            }
        }
    }

    fn escape(&mut self) -> Result<(), Refusal> {
        let kind = self.peek().ok_or(Refusal::Syntax)?;
        self.at += 1;
        match kind {
            b'"' | b'\\' | b'/' | b'b' | b'f' | b'n' | b'r' | b't' => Ok(()),
            b'u' => {
                let digits = self.bytes.get(self.at..self.at + 4).ok_or(Refusal::Syntax)?;
                self.at += 4;
                if digits.iter().all(u8::is_ascii_hexdigit) {
                    Ok(())
                } else {
                    Err(Refusal::Syntax)
                }
            }
            _ => Err(Refusal::Syntax),
        }
    }

    /// Skips an array or an object. Bit 0 of `nesting` is set if the innermost is an object, bit 1 for the next outer
    /// one.
    fn skip_composite(&mut self) -> Result<Value<'a>, Refusal> {
        let mut nesting: u32 = 0;
        let mut depth: u32 = 0;
        loop {
            self.skip_spaces();
            let opened = match self.peek() {
                Some(open @ (b'{' | b'[')) => {
                    self.at += 1;
                    depth += 1;
                    nesting = nesting << 1 | u32::from(open == b'{');
                    true
                }
                _ => {
                    self.scalar()?;
                    false
                }
            };
            if depth > DEPTH_MAX {
                return Err(Refusal::Syntax);
            }
            if !self.continues(&mut nesting, &mut depth, opened)? {
                return Ok(Value::Composite);
            }
        }
    }

    /// After a value or an opening bracket: goes to the next value; `false` when the outermost bracket is closed.
    fn continues(&mut self, nesting: &mut u32, depth: &mut u32, opened: bool) -> Result<bool, Refusal> {
        let mut empty = opened;
        while *depth > 0 {
            let object = *nesting & 1 == 1;
            self.skip_spaces();
            let next = self.peek().ok_or(Refusal::Syntax)?;
            if next == if object { b'}' } else { b']' } {
                self.at += 1;
                *nesting >>= 1;
                *depth -= 1;
                empty = false;
                continue;
            }
            if !empty {
                self.expect(b',')?;
            }
            if object {
                self.expect(b'"')?;
                self.string()?;
                self.expect(b':')?;
            }
            return Ok(true);
        }
        Ok(false)
    }

    #[inline]
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn token(&mut self) -> Result<u8, Refusal> {
        self.skip_spaces();
        let byte = self.peek().ok_or(Refusal::Syntax)?;
        self.at += 1;
        Ok(byte)
    }

    fn expect(&mut self, byte: u8) -> Result<(), Refusal> {
        if self.token()? == byte {
            Ok(())
        } else {
            Err(Refusal::Syntax)
        }
    }

    /// Of JSON's white space only the space can occur: the others poison a packet.
    #[inline]
    fn skip_spaces(&mut self) {
        while self.peek() == Some(b' ') {
            self.at += 1;
        }
    }
}
