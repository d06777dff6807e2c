//! S12: a wheel that for 200 ms turns without a command, or faster than 1.5 times its set point, is a runaway: both bridges
//! brake, latched. The rule applies while armed only: a resting robot may be pushed by hand, and its bridges are off
//! anyway.
//!
//! A motor pushes its wheel the way it is driven. One that is driven and seems to run away against that has an encoder that
//! counts backward (S13), and is named so: the controller then drives it ever harder, and this rule sees it first.

use rvac_protocol::message::Inhibit;
use rvac_units::Tick;

use crate::motion::WheelStatus;
use crate::rules::runaway::{RUNAWAY_MS, SLACK_UM_PER_S};
use crate::timing::HoldTimer;

/// Runaway of one wheel.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RunawayRule {
    excess: HoldTimer,
    against: HoldTimer,
}

impl RunawayRule {
    /// Returns what is to be latched: that the wheel has run away, or that its encoder counts against its motor.
    pub(crate) fn update(&mut self, wheel: WheelStatus, now: Tick) -> Option<Inhibit> {
        let Some(set_point) = wheel.set_point_um_per_s else {
            self.excess.restart();
            self.against.restart();
            return None;
        };
        let set_point = set_point.saturating_abs();
        let limit = set_point
            .saturating_add(set_point / 2)
            .saturating_add(SLACK_UM_PER_S)
            .saturating_add(wheel.speed_step_um_per_s);
        let excess = wheel.speed_um_per_s.saturating_abs() > limit;
        let against = excess && wheel.speed_um_per_s.signum() * wheel.duty.signum() < 0;
        let has_run = self.excess.for_at_least(excess && !against, now, RUNAWAY_MS);
        let is_against = self.against.for_at_least(against, now, RUNAWAY_MS);
        if is_against {
            Some(Inhibit::EncoderFault)
        } else {
            has_run.then_some(Inhibit::Runaway)
        }
    }
}
