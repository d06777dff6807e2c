//! S12: a wheel that for 200 ms turns without a command, or faster than 1.5 times its set point, is a runaway: both bridges
//! brake, latched. The rule applies while armed only: a resting robot may be pushed by hand, and its bridges are off
//! anyway.

use rvac_units::Tick;

use crate::motion::WheelStatus;
use crate::rules::runaway::{RUNAWAY_MS, SLACK_UM_PER_S};
use crate::timing::HoldTimer;

/// Runaway of one wheel.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RunawayRule {
    excess: HoldTimer,
}

impl RunawayRule {
    /// Returns whether the wheel has run away.
    pub(crate) fn update(&mut self, wheel: WheelStatus, now: Tick) -> bool {
        let Some(set_point) = wheel.set_point_um_per_s else {
            self.excess.restart();
            return false;
        };
        let set_point = set_point.saturating_abs();
        let limit = set_point
            .saturating_add(set_point / 2)
            .saturating_add(SLACK_UM_PER_S)
            .saturating_add(wheel.speed_step_um_per_s);
        let excess = wheel.speed_um_per_s.saturating_abs() > limit;
        self.excess.for_at_least(excess, now, RUNAWAY_MS)
    }
}
