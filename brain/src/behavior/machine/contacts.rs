//! On the dock's contacts at the end of the way home: home is where current flows.
//!
//! Contacts close on a dock that has no power, on dust, and in the field of a switch that hangs. Who stands there believes to be
//! charged and wakes up empty.

use super::{Behavior, Mode};
use crate::model::observation::ChargeFlow;
use crate::model::reason::Reason;
use crate::navigation::TaskContext;

/// Current must flow within this time, if it can be expected at all. The firmware looks at dock and pack for some seconds
/// before it lets it flow, and tells it in a report that comes once a second.
const FLOW_PATIENCE_US: u64 = 20_000_000;
/// The robot comes off and drives in again so often: the next time the contacts may meet better.
const DRY_TRIES_MAX: u32 = 2;

impl Behavior {
    /// What a robot on its way home does on contacts that are closed.
    pub(super) fn meet_contacts(&mut self, mind: &mut TaskContext) {
        if self.facts.charge_flow != Some(ChargeFlow::Missing) {
            self.dry_tries = 0;
            self.arrive(mind);
            return;
        }
        if self.mode != Mode::Working || self.is_leaving() {
            return;
        }
        let now_us = self.facts.now_us;
        let Some(since_us) = self.contacts_us else {
            self.contacts_us = Some(now_us);
            mind.decide("wait-for-current", Reason::Docked, 0.0);
            return;
        };
        if now_us.saturating_sub(since_us) < FLOW_PATIENCE_US {
            return;
        }
        if self.dry_tries < DRY_TRIES_MAX {
            self.dry_tries += 1;
            self.announce(Reason::NoChargeCurrent, mind);
        } else {
            self.dry_tries = 0;
            self.give_up_home(Reason::NoChargeCurrent, mind);
        }
    }

    /// The contacts opened while the robot waited for current on them.
    pub(super) fn lose_contacts(&mut self, mind: &mut TaskContext) {
        if self.slips_left() {
            self.announce(Reason::DockMissed, mind);
        } else {
            self.give_up_home(Reason::DockMissed, mind);
        }
    }

    /// Whether the robot stands on the contacts and waits for current.
    pub(super) fn waits_for_current(&self) -> bool {
        self.mode == Mode::Working && self.contacts_us.is_some()
    }

    /// A pack that is charged at last, after nothing had flown.
    pub(super) fn watch_dry_dock(&mut self, mind: &mut TaskContext) {
        if self.reason == Reason::NoChargeCurrent && self.facts.charge_flow == Some(ChargeFlow::Flowing) {
            self.enter(Mode::Docked, Reason::Docked, mind);
        }
    }

    fn is_leaving(&self) -> bool {
        self.job
            .as_ref()
            .is_some_and(crate::behavior::job::Job::is_departing)
    }
}
