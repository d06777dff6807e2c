//! S19: on the dock the robot moves only after `arm` with `undock`. Whenever the contacts close or open, stored motion is
//! cleared and the robot must be armed again: lifted off the dock, it stays still.

use rvac_units::Tick;

use crate::guarded::Permission;
use crate::timing::{Debounced, HoldTimer};

/// One sample is noise. While bouncing contacts open for a moment the robot counts as docked.
const SET_MS: u32 = 10;
const CLEAR_MS: u32 = 300;
/// With the contacts open for this long the robot has left the dock; closing them again is a new arrival.
const LEFT_MS: u32 = 1_000;

/// What changed at the dock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DockChange {
    /// The contacts closed: the robot arrived, or was put on the dock.
    Arrived,
    /// Taken off without an `undock`.
    TakenOff,
    /// Off the contacts after `undock`.
    Left,
}

/// State of the dock rule.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DockRule {
    contacts: Debounced<SET_MS, CLEAR_MS>,
    undocking: Permission,
    away: HoldTimer,
}

impl DockRule {
    /// Takes the raw contacts; returns a change that clears stored motion.
    pub(crate) fn update(&mut self, raw: bool, now: Tick) -> Option<DockChange> {
        let before = self.contacts.is_active();
        let docked = self.contacts.update(raw, now);
        if self.undocking.is_given() && self.away.for_at_least(!docked, now, LEFT_MS) {
            self.undocking = Permission::REFUSED;
        }
        match (before, docked) {
            (false, true) if !self.undocking.is_given() => Some(DockChange::Arrived),
            (true, false) if self.undocking.is_given() => Some(DockChange::Left),
            (true, false) => Some(DockChange::TakenOff),
            _ => None,
        }
    }

    /// Allows motion off the dock.
    pub(crate) const fn undock(&mut self) {
        self.undocking = Permission::GIVEN;
        self.away.restart();
    }

    /// Revokes the permission.
    pub(crate) const fn stay(&mut self) {
        self.undocking = Permission::REFUSED;
    }

    /// Whether the contacts are closed.
    pub(crate) const fn is_docked(&self) -> bool {
        self.contacts.is_active()
    }

    /// Whether that forbids motion.
    pub(crate) const fn inhibits(&self) -> bool {
        self.contacts.is_active() && !self.undocking.is_given()
    }
}
