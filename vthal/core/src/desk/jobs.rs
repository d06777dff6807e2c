//! What clients order for parts of the home: read, admitted, and reckoned beforehand.

use brain::Command;
use rvac_api::{JobEstimate, JobOrder, Update};

use super::home::{known_home, with_places};
use super::words::to_order;
use crate::brain_session::BrainSession;
use crate::refusal::Refusal;

/// A client draws a spot as large as the brain cleans it.
const _: () = assert!(rvac_api::SPOT_RADIUS_M == brain::SPOT_RADIUS_M);

/// What the brain is told to clean parts of the home.
///
/// # Errors
/// Refused as the brain would refuse it.
pub(crate) fn clean_command(order: &JobOrder, mind: Option<&BrainSession>) -> Result<Command, Refusal> {
    let brain = known_home(mind)?.brain();
    let order = to_order(&with_places(order, brain)?)?;
    let command = Command::CleanParts { order: order.clone() };
    match brain.admit(&command) {
        Ok(()) => Ok(command),
        Err(reason) => Err(Refusal::of_order(reason, &order, brain)),
    }
}

/// What such a job will take. A plan of the whole order takes long enough to be felt by wheels that turn, so none is made while
/// they may.
///
/// # Errors
/// A job runs, or the brain would refuse the order.
pub(crate) fn estimate(
    id: Option<u32>,
    order: &JobOrder,
    mind: Option<&BrainSession>,
) -> Result<Update, Refusal> {
    let mind = known_home(mind)?;
    let brain = mind.brain();
    let order = to_order(&with_places(order, brain)?)?;
    if !mind.rests() {
        return Err("job-runs".into());
    }
    let found = brain
        .estimate_order(&order)
        .map_err(|reason| Refusal::of_order(reason, &order, brain))?;
    Ok(Update::JobEstimate(JobEstimate {
        id,
        floor_m2: found.floor_m2,
        time_s: found.time_s,
        charge: found.charge,
        share: found.share,
        share_low: found.share_low,
    }))
}
