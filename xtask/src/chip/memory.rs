//! The stretches of a chip's memory, and how much of each a firmware may take.

use serde::Deserialize;
use std::ops::Range;

/// A stretch of memory.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct Region {
    /// Where it begins: its physical address.
    pub(crate) start: u32,
    /// Its length, bytes.
    pub(crate) bytes: u32,
    /// How much of it a firmware of ours may take, bytes; all of it when nothing is said.
    budget_bytes: Option<u32>,
}

impl Region {
    /// Its addresses.
    pub(crate) fn addresses(&self) -> Range<u32> {
        self.start..self.start.saturating_add(self.bytes)
    }

    /// The same with more that a firmware of ours may take.
    pub(crate) fn with_allowance(self, bytes: u32) -> Self {
        let budget = self.budget_bytes().saturating_add(bytes).min(self.bytes);
        Self {
            budget_bytes: Some(budget),
            ..self
        }
    }

    /// How much of it a firmware of ours may take, bytes.
    pub(crate) fn budget_bytes(&self) -> u32 {
        self.budget_bytes.unwrap_or(self.bytes)
    }
}
