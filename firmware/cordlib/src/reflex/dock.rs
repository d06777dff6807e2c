//! S19: on the dock the robot moves only after `arm` with `undock`. Whenever the contacts close or open, stored motion is
//! cleared and the robot must be armed again: lifted off the dock, it stays still. [`crate::arming`] keeps the permission.

use rvac_units::Tick;

use crate::arming::ArmingEvent;
use crate::rules::dock::{CLEAR_MS, SET_MS};
use crate::timing::Debounced;

/// The dock's contacts.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DockRule {
    contacts: Debounced<SET_MS, CLEAR_MS>,
}

impl DockRule {
    /// Takes the raw contacts; returns their change, as arming sees it.
    pub(crate) fn update(&mut self, raw: bool, now: Tick) -> Option<ArmingEvent> {
        let before = self.contacts.is_active();
        match (before, self.contacts.update(raw, now)) {
            (false, true) => Some(ArmingEvent::Arrival),
            (true, false) => Some(ArmingEvent::TakenOff),
            _ => None,
        }
    }

    /// Whether the contacts are closed.
    pub(crate) const fn is_docked(&self) -> bool {
        self.contacts.is_active()
    }
}
