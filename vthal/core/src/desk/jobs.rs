//! Orders of clients for parts of the home: read, admitted and estimated.

use brain::{Brain, CleaningOrder, EstimateWork, JobCommand, OrderRefusal};
use rvac_api::{JobEstimate, JobOrder, Update};

use super::home::{known_home, with_places};
use super::words::to_order;
use crate::brain_session::BrainSession;
use crate::refusal::Refusal;

/// A client draws a spot as large as the brain cleans it.
const _: () = assert!(rvac_api::SPOT_RADIUS_M == brain::SPOT_RADIUS_M);

/// The command to clean parts of the home, if the brain would obey it now.
///
/// # Errors
/// Refused as the brain would refuse it.
pub(crate) fn clean_command(
    order: &JobOrder,
    brain_session: Option<&BrainSession>,
) -> Result<JobCommand, Refusal> {
    let brain = known_home(brain_session)?.brain();
    let order = to_order(&with_places(order, brain)?)?;
    let command = JobCommand::CleanParts { order: order.clone() };
    match brain.admit(&command) {
        Ok(()) => Ok(command),
        Err(reason) => Err(Refusal::of_order(
            &brain.order_refusal(reason, &order),
            &order,
            brain,
        )),
    }
}

/// What an estimate of such a job needs, if the brain could make it now.
///
/// # Errors
/// As [`EstimatedJob::begin`], as far as that can be told without looking at the floor.
pub(crate) fn estimable<'a>(
    order: &JobOrder,
    brain_session: Option<&'a BrainSession>,
) -> Result<(&'a Brain, CleaningOrder), Refusal> {
    let brain_session = known_home(brain_session)?;
    let brain = brain_session.brain();
    let order = to_order(&with_places(order, brain)?)?;
    if brain_session.rests() {
        Ok((brain, order))
    } else {
        Err("job-runs".into())
    }
}

/// An estimate in the making.
#[derive(Debug)]
pub(crate) struct EstimatedJob {
    order: CleaningOrder,
    work: EstimateWork,
}

impl EstimatedJob {
    /// Begins to find out what such a job will take, and whether the brain would refuse the order. Both take tens of milliseconds, so they
    /// are done in steps; and the robot must rest when they begin.
    ///
    /// # Errors
    /// As [`estimable`].
    pub(crate) fn begin(order: &JobOrder, brain_session: Option<&BrainSession>) -> Result<Self, Refusal> {
        let (brain, order) = estimable(order, brain_session)?;
        let work = brain.begin_estimate(&order);
        Ok(Self { order, work })
    }

    /// Does the next step. Must not be called again after it returned what the job takes, or why it cannot be done.
    pub(crate) fn go_on(
        &mut self,
        id: Option<u32>,
        brain_session: Option<&BrainSession>,
    ) -> Option<Result<Update, Refusal>> {
        let found = self.work.go_on()?;
        let refused = |refusal: OrderRefusal| match brain_session {
            Some(brain_session) => Refusal::of_order(&refusal, &self.order, brain_session.brain()),
            None => Refusal::from(refusal.reason),
        };
        Some(found.map_err(refused).map(|found| {
            Update::JobEstimate(JobEstimate {
                id,
                floor_m2: found.floor_m2,
                time_s: found.time_s,
                charge: found.charge,
                recharges: found.recharges,
                share: found.share,
                share_low: found.share_low,
            })
        }))
    }
}
