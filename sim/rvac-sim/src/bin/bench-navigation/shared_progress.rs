//! Progress of work that several threads do.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::progress::Progress;

/// Progress of work that several do at once.
#[derive(Debug)]
pub(crate) struct SharedProgress {
    line: Progress,
    count: usize,
    /// Thousandths of single pieces of work, all together.
    done: AtomicU64,
}

impl SharedProgress {
    pub(crate) fn new(what: &'static str, count: usize) -> Self {
        Self {
            line: Progress::new(what),
            count,
            done: AtomicU64::new(0),
        }
    }

    /// Takes shares of 0 to 1 of one piece of work.
    pub(crate) fn piece(&self) -> impl FnMut(f64) {
        let mut before = 0;
        move |share| {
            let now = (1_000.0 * share) as u64;
            let more = now.saturating_sub(before);
            before += more;
            let done = self.done.fetch_add(more, Ordering::Relaxed) + more;
            self.line.show(done as f64 / (1_000.0 * self.count as f64));
        }
    }

    pub(crate) fn clear(&self) {
        self.line.clear();
    }
}
