//! Estimates of jobs wait for their turn, and are made in steps: each plans a whole order, which takes tens of milliseconds, and in between
//! stops, the link and telemetry are served.

use std::collections::VecDeque;

use rvac_api::JobOrder;

use super::audience::{Asker, Asking};
use super::jobs::EstimatedJob;
use super::reply::Reply;
use crate::ClientId;
use crate::brain_session::BrainSession;
use crate::refusal::Refusal;

/// Estimates of one client that wait at most.
const WAITING_MAX: usize = 4;
/// So many are made at once after a pause; a person who draws a zone asks for one.
const BURST: u32 = 2;
/// Then one in this time.
const EVERY_US: u64 = 250_000;
/// Pause between two steps of one: whatever else comes is served in between.
const STEP_US: u64 = 2_000;

/// What waits.
#[derive(Debug, Default)]
pub(crate) struct EstimateDesk {
    /// In the order of the requests.
    waiting: VecDeque<Asking<JobOrder>>,
    /// Who was served last: with several, they take turns.
    served: Option<ClientId>,
    /// Estimates of the present burst, and when one of them is given back.
    spent: u32,
    refill_us: u64,
    in_progress: Option<(Asker, EstimatedJob)>,
    /// When a step of that was done last.
    stepped_us: u64,
}

impl EstimateDesk {
    /// Takes a request that the brain could answer now.
    ///
    /// # Errors
    /// The client has as many waiting as one may have.
    pub(crate) fn ask(&mut self, asker: Asker, order: JobOrder) -> Result<(), Refusal> {
        let own = self
            .waiting
            .iter()
            .filter(|waiting| waiting.asker.client == asker.client);
        if own.count() >= WAITING_MAX {
            return Err(Refusal::from("too-many-estimates"));
        }
        let request = order;
        self.waiting.push_back(Asking { asker, request });
        Ok(())
    }

    /// Goes on with the present one by a step, or begins with the next one. Gives the answer to one that is done.
    pub(crate) fn go_on(
        &mut self,
        now_us: u64,
        brain_session: Option<&BrainSession>,
    ) -> Option<(Asker, Result<Reply, Refusal>)> {
        let Some((asker, job)) = &mut self.in_progress else {
            let Asking { asker, request } = self.next(now_us)?;
            self.stepped_us = now_us;
            match EstimatedJob::begin(&request, brain_session) {
                Ok(job) => self.in_progress = Some((asker, job)),
                Err(refusal) => return Some((asker, Err(refusal))),
            }
            return None;
        };
        if now_us < self.stepped_us + STEP_US {
            return None;
        }
        self.stepped_us = now_us;
        let (asker, answer) = (*asker, job.go_on(asker.id, brain_session)?);
        self.in_progress = None;
        Some((asker, answer.map(Reply::from)))
    }

    /// The next one, if its turn has come.
    fn next(&mut self, now_us: u64) -> Option<Asking<JobOrder>> {
        while self.spent > 0 && now_us >= self.refill_us {
            self.spent -= 1;
            self.refill_us += EVERY_US;
        }
        if self.spent >= BURST {
            return None;
        }
        let is_other = |waiting: &Asking<JobOrder>| Some(waiting.asker.client) != self.served;
        let place = self.waiting.iter().position(is_other).unwrap_or(0);
        let next = self.waiting.remove(place)?;
        if self.spent == 0 {
            self.refill_us = now_us + EVERY_US;
        }
        self.spent += 1;
        self.served = Some(next.asker.client);
        Some(next)
    }

    /// When there is something to do.
    pub(crate) fn next_wake_us(&self) -> Option<u64> {
        if self.in_progress.is_some() {
            return Some(self.stepped_us + STEP_US);
        }
        let due_us = if self.spent >= BURST { self.refill_us } else { 0 };
        (!self.waiting.is_empty()).then_some(due_us)
    }

    /// A client is gone.
    pub(crate) fn forget(&mut self, client: ClientId) {
        self.waiting.retain(|waiting| waiting.asker.client != client);
        self.in_progress = self
            .in_progress
            .take()
            .filter(|(asker, _)| asker.client != client);
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::JobOrder;

    use super::{EVERY_US, EstimateDesk, WAITING_MAX};
    use crate::ClientId;
    use crate::desk::audience::Asker;

    fn asker(client: u64, id: u32) -> Asker {
        Asker {
            client: ClientId(client),
            id: Some(id),
        }
    }

    #[test]
    fn clients_take_turns_and_one_that_floods_is_refused() {
        let mut desk = EstimateDesk::default();
        let mut refused = 0;
        for id in 0..30 {
            refused += u32::from(desk.ask(asker(1, id), JobOrder::default()).is_err());
        }
        assert_eq!(refused, 30 - WAITING_MAX as u32);
        assert!(desk.ask(asker(2, 0), JobOrder::default()).is_ok());
        let mut served = Vec::new();
        for tick in 0..200 {
            let now_us = tick * 10_000;
            while let Some(next) = desk.next(now_us) {
                served.push((now_us, next.asker.client.0));
            }
        }
        let clients: Vec<u64> = served.iter().map(|(_, client)| *client).collect();
        assert_eq!(clients, [1, 2, 1, 1, 1]);
        let times: Vec<u64> = served.iter().map(|(now_us, _)| *now_us).collect();
        assert_eq!(times, [0, 0, EVERY_US, 2 * EVERY_US, 3 * EVERY_US]);
        assert_eq!(desk.next_wake_us(), None);
    }
}
