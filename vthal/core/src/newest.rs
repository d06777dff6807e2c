//! Numbered entries, the newest of which are kept for clients that come later.

use std::collections::VecDeque;

/// The newest `KEPT` entries.
#[derive(Debug)]
pub(crate) struct Newest<T, const KEPT: usize> {
    entries: VecDeque<T>,
    written: u64,
}

impl<T, const KEPT: usize> Default for Newest<T, KEPT> {
    fn default() -> Self {
        Self {
            entries: VecDeque::new(),
            written: 0,
        }
    }
}

impl<T: Clone, const KEPT: usize> Newest<T, KEPT> {
    /// Keeps the entry that is made with the next number, from 1 on, and gives it back.
    pub(crate) fn keep(&mut self, entry: impl FnOnce(u64) -> T) -> T {
        self.written += 1;
        let entry = entry(self.written);
        if self.entries.len() == KEPT {
            self.entries.pop_front();
        }
        self.entries.push_back(entry.clone());
        entry
    }

    /// What is kept, oldest first.
    pub(crate) fn entries(&self) -> impl Iterator<Item = &T> {
        self.entries.iter()
    }
}
