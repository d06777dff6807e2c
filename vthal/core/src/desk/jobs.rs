//! Orders of clients for parts of the home: read, admitted and estimated.

use brain::{Brain, CleaningOrder, JobCommand};
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
        Err(reason) => Err(Refusal::of_order(reason, &order, brain)),
    }
}

/// What an estimate of such a job needs, if the brain could make it now.
///
/// # Errors
/// As [`estimate`], as far as that can be told without planning.
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

/// What such a job will take. Planning the whole order takes tens of milliseconds, which would delay the control of turning wheels,
/// so the robot must rest.
///
/// # Errors
/// A job runs, or the brain would refuse the order.
pub(crate) fn estimate(
    id: Option<u32>,
    order: &JobOrder,
    brain_session: Option<&BrainSession>,
) -> Result<Update, Refusal> {
    let (brain, order) = estimable(order, brain_session)?;
    let found = brain
        .estimate_order(&order)
        .map_err(|reason| Refusal::of_order(reason, &order, brain))?;
    Ok(Update::JobEstimate(JobEstimate {
        id,
        floor_m2: found.floor_m2,
        time_s: found.time_s,
        charge: found.charge,
        recharges: found.recharges,
        share: found.share,
        share_low: found.share_low,
    }))
}
