//! One flash memory: its bytes, and each of its words as a decoded instruction.

use crate::cpu::decode::decode_at;
use crate::cpu::operation::{Operation, Uncommon};
use std::collections::BTreeSet;

/// A flash and what is decoded from it.
#[derive(Clone, Debug)]
pub(super) struct Flash {
    bytes: Vec<u8>,
    operations: Vec<Operation>,
    breakpoints: BTreeSet<usize>,
}

impl Flash {
    /// A flash with these bytes, a multiple of four.
    pub(super) fn new(bytes: &[u8]) -> Self {
        let mut flash = Self {
            bytes: bytes.to_vec(),
            operations: vec![Operation::Nop; bytes.len() / 4],
            breakpoints: BTreeSet::new(),
        };
        flash.decode(0, bytes.len() / 4);
        flash
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    pub(super) fn operations(&self) -> &[Operation] {
        &self.operations
    }

    /// Replaces bytes that lie inside.
    pub(super) fn write(&mut self, start: usize, bytes: &[u8]) {
        if let Some(place) = self.bytes.get_mut(start..start + bytes.len()) {
            place.copy_from_slice(bytes);
        }
        // The neighbours' load stalls depend on what was written.
        self.decode(
            (start / 4).saturating_sub(1),
            (start + bytes.len()).div_ceil(4) + 1,
        );
    }

    /// Puts or takes a breakpoint before the word at a byte offset.
    pub(super) fn mark(&mut self, start: usize, wanted: bool) {
        let index = start / 4;
        if wanted {
            self.breakpoints.insert(index);
        } else {
            self.breakpoints.remove(&index);
        }
        self.decode(index, index + 1);
    }

    fn decode(&mut self, from: usize, to: usize) {
        let bytes = &self.bytes;
        let word = |index: usize| {
            let bytes = bytes.get(index * 4..index * 4 + 4)?;
            Some(u32::from_le_bytes(bytes.try_into().ok()?))
        };
        let places = self.operations.iter_mut().enumerate().take(to).skip(from);
        for (index, place) in places {
            *place = match self.breakpoints.contains(&index) {
                true => Operation::Uncommon(Uncommon::Breakpoint),
                false => decode_at(word, index),
            };
        }
    }
}
