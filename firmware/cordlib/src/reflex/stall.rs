//! S11: a wheel motor above its current limit for 100 ms, or driven above 30 % for 300 ms without a single encoder
//! count, is switched off; that is latched. (The brush half of S11 is in `cleaning`, next to the motor it reverses.)

use rvac_units::{Current, Tick};

use crate::rules::stall::{OVER_CURRENT_MS, STALL_DUTY, STANDSTILL_MS};
use crate::timing::HoldTimer;

/// Overload of one motor.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StallRule {
    over_current: HoldTimer,
    standstill: HoldTimer,
}

/// What the rule looks at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Load {
    /// Duty in millionths.
    pub(crate) duty: i32,
    /// Whether its sensor has counted since the last period; `None` without a sensor.
    pub(crate) turned: Option<bool>,
    /// Current and its limit, if measured.
    pub(crate) current: Option<(Current, Current)>,
}

impl StallRule {
    /// Returns whether the motor is overloaded.
    pub(crate) fn update(&mut self, load: Load, now: Tick) -> bool {
        let above = load
            .current
            .is_some_and(|(current, limit)| current.magnitude() > limit.0);
        let blocked = load.duty.saturating_abs() > STALL_DUTY && load.turned == Some(false);
        let over_current = self.over_current.for_at_least(above, now, OVER_CURRENT_MS);
        self.standstill.for_at_least(blocked, now, STANDSTILL_MS) || over_current
    }

    /// Restarts the timers after the motor was switched off.
    pub(crate) const fn restart(&mut self) {
        self.over_current.restart();
        self.standstill.restart();
    }
}
