//! Changes that are answered when the disk has them.

use rvac_api::LogLevel;

use super::audience::{Asker, Teller};
use super::journal::LogSource;
use super::reply::Reply;
use crate::refusal::Refusal;

/// Numbers of what is handed to the disk, and who waits for it, each with how it was before.
#[derive(Debug)]
pub(super) struct Awaited<T> {
    orders: u64,
    waiting: Vec<(u64, Asker, T)>,
}

impl<T> Default for Awaited<T> {
    fn default() -> Self {
        Self {
            orders: 0,
            waiting: Vec::new(),
        }
    }
}

impl<T> Awaited<T> {
    /// The number of what is handed over now.
    pub(super) fn next_order(&mut self) -> u64 {
        self.orders += 1;
        self.orders
    }

    /// Somebody waits for what was handed over last.
    pub(super) fn wait(&mut self, asker: Asker, before: T) {
        self.waiting.push((self.orders, asker, before));
    }

    /// The disk has what was handed over under this number, or will not have it. Who waited for that or for what came before, the
    /// newest first.
    fn settle(&mut self, number: u64) -> impl Iterator<Item = (Asker, T)> {
        let (settled, waiting) = core::mem::take(&mut self.waiting)
            .into_iter()
            .partition::<Vec<_>, _>(|(order, ..)| *order <= number);
        self.waiting = waiting;
        settled
            .into_iter()
            .rev()
            .map(|(_, asker, before)| (asker, before))
    }

    /// The disk has what it was given under this number, or says why it has not; the client that waits is answered. Gives what must be
    /// taken back, the newest first.
    pub(super) fn kept(
        &mut self,
        number: u64,
        result: Result<(), Refusal>,
        teller: &mut Teller<'_>,
    ) -> Vec<T> {
        if let Err(refusal) = &result {
            teller.log(LogLevel::Error, LogSource::Vthal, refusal.text.clone());
        }
        let mut undone = Vec::new();
        for (asker, before) in self.settle(number) {
            teller.answer(asker, result.clone().map(|()| Reply::Done));
            if result.is_err() {
                undone.push(before);
            }
        }
        undone
    }
}
