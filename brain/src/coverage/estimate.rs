//! What a job will take, before it begins.

use super::plan::{PlanSettings, plan_area};
use super::systematic::{KEEP_OFF_M, SIGMA_MIN_M, reachable};
use crate::behavior::Reason;
use crate::config::BrainConfig;
use crate::geometry::Pose2;
use crate::mapping::{Cell, Map};
use crate::order::{CleaningOrder, HomePart};

/// Real jobs take this many times as long as their plans: speeding up and braking, contacts, leftovers of an uncertain pose.
const DRIVEN: f64 = 1.25;

/// An expectation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JobEstimate {
    /// Floor that can be swept, each part once, square metres.
    pub floor_m2: f64,
    /// Time, seconds.
    pub time_s: f64,
}

/// What `order` takes for a robot that starts at `start`.
///
/// # Errors
/// Why the order cannot be carried out in this map.
pub(crate) fn estimate(
    order: &CleaningOrder,
    (map, start): (&Map, Pose2),
    config: &BrainConfig,
) -> Result<JobEstimate, Reason> {
    order.fits(map)?;
    let settings = PlanSettings {
        swath_m: config.body.swath_m,
        sigma_m: SIGMA_MIN_M,
        cruise_m_per_s: config.speeds.cruise_m_per_s,
        turn_rad_per_s: config.speeds.turn_max_rad_per_s,
    };
    let ground = reachable(map.knowledge(), config.body.radius_m + KEEP_OFF_M, &[]);
    let mut whole = JobEstimate::default();
    let mut pose = start;
    let mut add = |part: Option<&HomePart>| {
        let wanted = |cell: Cell| part.is_none_or(|part| part.contains(cell, map));
        let plan = plan_area(&ground, (wanted, |_| false), pose, &settings);
        if let Some(last) = plan.pieces.last() {
            pose = last.at(1.0);
        }
        whole.floor_m2 += plan.floor_m2;
        whole.time_s += DRIVEN * f64::from(order.passes()) * plan.time_s;
    };
    if order.parts().is_empty() {
        add(None);
    }
    for part in order.parts() {
        add(Some(part));
    }
    if whole.floor_m2 > 0.0 {
        Ok(whole)
    } else {
        Err(Reason::NoMap)
    }
}
