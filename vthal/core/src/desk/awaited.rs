//! Changes that are answered when the disk has them.

use rvac_api::LogLevel;

use super::audience::{Asker, Teller};
use super::journal::LogSource;
use super::reply::Reply;
use crate::refusal::Refusal;

/// What is handed to the disk, one after the other, and who waits for it, each with how it was before. While the disk has one, changes
/// gather for the next: so what is answered, and what is taken back, is what the disk has.
#[derive(Debug)]
pub(super) struct Awaited<T> {
    orders: u64,
    /// The disk has the newest order and has not answered.
    is_under_way: bool,
    /// Something changed since.
    is_stale: bool,
    /// Each with the order that contains it.
    waiting: Vec<(u64, Asker, T)>,
}

/// What follows from an answer of the disk.
#[derive(Debug)]
pub(super) struct Settled<T> {
    /// What must be taken back, the newest first.
    pub(super) undone: Vec<T>,
    /// Whether what changed meanwhile is to be handed over.
    pub(super) hands_over: bool,
}

impl<T> Default for Awaited<T> {
    fn default() -> Self {
        Self {
            orders: 0,
            is_under_way: false,
            is_stale: false,
            waiting: Vec::new(),
        }
    }
}

impl<T> Awaited<T> {
    /// Something has changed: the number under which it is handed over now; `None` while the disk has not answered, then it is handed
    /// over after that.
    pub(super) fn change(&mut self) -> Option<u64> {
        self.is_stale = self.is_under_way;
        if self.is_under_way {
            return None;
        }
        self.is_under_way = true;
        self.orders += 1;
        Some(self.orders)
    }

    /// Somebody waits for what was changed last.
    pub(super) fn wait(&mut self, asker: Asker, before: T) {
        let order = self.orders + u64::from(self.is_stale);
        self.waiting.push((order, asker, before));
    }

    /// The disk has what it was given under this number, or says why it has not; the clients that wait are answered. When it has not,
    /// what changed meanwhile is refused as well: it rests on that.
    pub(super) fn kept(
        &mut self,
        number: u64,
        result: Result<(), Refusal>,
        teller: &mut Teller<'_>,
    ) -> Settled<T> {
        self.is_under_way = false;
        let hands_over = core::mem::take(&mut self.is_stale) && result.is_ok();
        if let Err(refusal) = &result {
            teller.log(LogLevel::Error, LogSource::Vthal, refusal.text.clone());
        }
        let is_settled = |(order, ..): &(u64, Asker, T)| *order <= number || result.is_err();
        let (settled, waiting) = core::mem::take(&mut self.waiting)
            .into_iter()
            .partition(is_settled);
        self.waiting = waiting;
        let mut undone = Vec::new();
        for (_, asker, before) in Vec::into_iter(settled).rev() {
            teller.answer(asker, result.clone().map(|()| Reply::Done));
            if result.is_err() {
                undone.push(before);
            }
        }
        Settled { undone, hands_over }
    }
}
