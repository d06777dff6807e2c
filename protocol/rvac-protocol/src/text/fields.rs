//! The members of one packet, picked by name.

use super::scan::{Members, Value};
use crate::message::Refusal;
use crate::span::Span;

/// How unknown keys are treated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum UnknownKeys {
    /// Refused, in motion commands that a person types: a mistyped key.
    Refuse,
    /// Ignored: a newer peer may send more.
    Ignore,
}

/// The values of `N` keys, in the order of the requested keys.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fields<'a, const N: usize> {
    values: [Option<Value<'a>>; N],
}

impl<'a, const N: usize> Fields<'a, N> {
    /// Reads the object `text`.
    pub(crate) fn read(text: &'a [u8], keys: [&str; N], unknown: UnknownKeys) -> Result<Self, Refusal> {
        let mut values = [None; N];
        let mut members = Members::of(text)?;
        while let Some((key, value)) = members.next()? {
            let slot = keys
                .iter()
                .zip(&mut values)
                .find_map(|(name, slot)| (name.as_bytes() == key).then_some(slot));
            match slot {
                Some(Some(_)) => return Err(Refusal::Duplicate),
                Some(slot) => *slot = Some(value),
                None if unknown == UnknownKeys::Refuse => return Err(Refusal::UnknownKey),
                None => {}
            }
        }
        Ok(Self { values })
    }

    pub(crate) fn get(&self, index: usize) -> Option<Value<'a>> {
        self.values.get(index).copied().flatten()
    }

    fn required(&self, index: usize) -> Result<Value<'a>, Refusal> {
        self.get(index).ok_or(Refusal::Missing)
    }

    /// A number that must be there.
    pub(crate) fn number(&self, index: usize, span: Span) -> Result<i64, Refusal> {
        self.required(index)?.number(span)
    }

    /// As [`number`](Self::number), for spans within `i32`.
    pub(crate) fn int(&self, index: usize, span: Span) -> Result<i32, Refusal> {
        i32::try_from(self.number(index, span)?).map_err(|_| Refusal::Range)
    }

    /// As [`number`](Self::number), for spans within `u32`.
    pub(crate) fn total(&self, index: usize) -> Result<u32, Refusal> {
        u32::try_from(self.number(index, crate::span::TOTAL)?).map_err(|_| Refusal::Range)
    }

    /// As [`number`](Self::number), for spans within `u16`.
    pub(crate) fn word(&self, index: usize, span: Span) -> Result<u16, Refusal> {
        u16::try_from(self.number(index, span)?).map_err(|_| Refusal::Range)
    }

    /// As [`number`](Self::number), for spans within `u8`.
    pub(crate) fn byte(&self, index: usize) -> Result<u8, Refusal> {
        u8::try_from(self.number(index, crate::span::BYTE)?).map_err(|_| Refusal::Range)
    }

    /// A text that must be there.
    pub(crate) fn text(&self, index: usize) -> Result<&'a [u8], Refusal> {
        self.required(index)?.text()
    }

    /// A text that is empty when absent.
    pub(crate) fn text_or_empty(&self, index: usize) -> Result<&'a [u8], Refusal> {
        self.get(index).map_or(Ok(&[]), Value::text)
    }

    /// A truth value that must be there.
    pub(crate) fn flag(&self, index: usize) -> Result<bool, Refusal> {
        self.required(index)?.flag()
    }

    /// Whether the key is there.
    pub(crate) fn has(&self, index: usize) -> bool {
        self.get(index).is_some()
    }
}

/// Whether the space-separated list `words` has `word`.
pub(crate) fn lists(words: &[u8], word: &str) -> bool {
    words
        .split(|byte| *byte == b' ')
        .any(|listed| listed == word.as_bytes())
}
