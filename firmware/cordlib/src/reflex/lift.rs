//! S10: a hanging wheel switches wheels, brushes and suction off until both wheels have stood for 1 s and a new command
//! comes.

use rvac_protocol::message::WheelDrops;
use rvac_units::Tick;

use crate::timing::Debounced;

/// A threshold makes a wheel hang for a moment; well below the 50 ms of the rule.
const SET_MS: u32 = 15;
const CLEAR_MS: u32 = 50;
const STANDING_MS: u32 = 1_000;

/// The wheel drop switches as the rule sees them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LiftRule {
    left: Debounced<SET_MS, CLEAR_MS>,
    right: Debounced<SET_MS, CLEAR_MS>,
    lifted: Debounced<0, STANDING_MS>,
}

impl LiftRule {
    /// Takes the raw switches; returns whether the robot counts as lifted.
    pub(crate) fn update(&mut self, raw: WheelDrops, now: Tick) -> bool {
        let left = self.left.update(raw.left, now);
        let right = self.right.update(raw.right, now);
        self.lifted.update(left || right, now)
    }

    /// Wheels that hang now, without the second of standing.
    pub(crate) const fn hanging(&self) -> WheelDrops {
        WheelDrops {
            left: self.left.is_active(),
            right: self.right.is_active(),
        }
    }
}
