//! Changes that are answered when the disk has them.

use rvac_api::{Failure, LogLevel, Update};

use super::Core;
use crate::Outputs;
use crate::journal::Part;
use crate::outputs::{Delivery, Recipients};
use crate::scheduler::Asker;

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
    pub(super) fn settle(&mut self, number: u64) -> impl Iterator<Item = (Asker, T)> {
        let (settled, waiting) = core::mem::take(&mut self.waiting)
            .into_iter()
            .partition::<Vec<_>, _>(|(order, ..)| *order <= number);
        self.waiting = waiting;
        settled
            .into_iter()
            .rev()
            .map(|(_, asker, before)| (asker, before))
    }
}

/// A kind of change: why it is refused when the disk does not take it, who waits, and how it is taken back.
pub(super) struct Change<T> {
    pub(super) refused_as: &'static str,
    pub(super) waiting: fn(&mut Core) -> &mut Awaited<T>,
    pub(super) take_back: fn(&mut Core, T),
}

impl Core {
    /// The disk has what it was given under this number, or says why it has not.
    pub(super) fn on_kept<T>(
        &mut self,
        now_us: u64,
        (change, number, result): (&Change<T>, u64, Result<(), String>),
        outputs: &mut Outputs,
    ) {
        let refused = result.err().map(|text| (change.refused_as, text));
        if let Some((_, text)) = &refused {
            self.log(now_us, (LogLevel::Error, Part::Vthal, text.clone()), outputs);
        }
        let settled: Vec<_> = (change.waiting)(self).settle(number).collect();
        for (asker, before) in settled {
            if refused.is_some() {
                (change.take_back)(self, before);
            }
            answer(asker, refused.clone(), outputs);
        }
    }
}

/// Tells whoever asked what came of it. A refusal is told also to those who gave no number.
pub(super) fn answer((client, id): Asker, refused: Option<(&'static str, String)>, outputs: &mut Outputs) {
    let update = match (refused, id) {
        (Some((reason, text)), id) => Update::Failed(Failure {
            id,
            reason: reason.to_owned(),
            text,
        }),
        (None, Some(id)) => Update::Done { id },
        (None, None) => return,
    };
    outputs.deliveries.push(Delivery {
        to: Recipients::One(client),
        update,
    });
}
