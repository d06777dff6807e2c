//! S10: a hanging wheel switches wheels, brushes and suction off until both wheels have been on the floor for 1 s and a new
//! command comes.

use rvac_protocol::message::WheelDrops;
use rvac_units::Tick;

use crate::rules::lift::{CLEAR_MS, GROUNDED_MS, SET_MS};
use crate::timing::Debounced;

/// State of the lift rule.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LiftRule {
    left: Debounced<SET_MS, CLEAR_MS>,
    right: Debounced<SET_MS, CLEAR_MS>,
    lifted: Debounced<0, GROUNDED_MS>,
}

impl LiftRule {
    /// Takes the raw switches; returns whether the robot counts as lifted.
    pub(crate) fn update(&mut self, raw: WheelDrops, now: Tick) -> bool {
        let left = self.left.update(raw.left, now);
        let right = self.right.update(raw.right, now);
        self.lifted.update(left || right, now)
    }

    /// Wheels that hang now, without the 1 s hold.
    pub(crate) const fn hanging(&self) -> WheelDrops {
        WheelDrops {
            left: self.left.is_active(),
            right: self.right.is_active(),
        }
    }
}
