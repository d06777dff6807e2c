//! Docking is complete only when charge current flows.
//!
//! Contacts also close on a dock without power, on dust, or by a switch that is stuck. A robot that takes them for a dock waits there
//! until its pack is empty.

use super::{Behavior, Mode};
use crate::behavior::parameters::CHARGING;
use crate::model::decision::DecisionKind;
use crate::model::observation::ChargeFlow;
use crate::model::reason::Reason;
use crate::navigation::TaskContext;

impl Behavior {
    /// The contacts have closed at the end of the path home.
    pub(super) fn meet_contacts(&mut self, context: &mut TaskContext) {
        if self.facts.charge_flow != Some(ChargeFlow::Missing) {
            self.no_current_tries = 0;
            self.arrive(context);
            return;
        }
        if self.mode != Mode::Working || self.is_leaving() {
            return;
        }
        let now_us = self.facts.now_us;
        let Some(since_us) = self.contacts_us else {
            self.contacts_us = Some(now_us);
            context.decide(DecisionKind::WaitForCurrent, Reason::Docked, 0.0);
            return;
        };
        if now_us.saturating_sub(since_us) < CHARGING.flow_within_us {
            return;
        }
        if self.no_current_tries < CHARGING.no_current_tries_max {
            self.no_current_tries += 1;
            self.announce(Reason::NoChargeCurrent, context);
        } else {
            self.no_current_tries = 0;
            self.give_up_home(Reason::NoChargeCurrent, context);
        }
    }

    /// The contacts have opened while the robot waited for current.
    pub(super) fn lose_contacts(&mut self, context: &mut TaskContext) {
        if self.slips_left() {
            self.announce(Reason::DockMissed, context);
        } else {
            self.give_up_home(Reason::DockNoContact, context);
        }
    }

    /// Whether the contacts, which had lost their voltage while the robot stood on them, can be relied upon again.
    pub(super) fn is_back_on_contacts(&self) -> bool {
        !is_loss(self.reason) || self.contact_watch.is_closed_for_good(self.facts.now_us)
    }

    /// Whether the robot stands on its dock, with the contacts closed or just dead.
    pub(super) fn is_on_dock(&self) -> bool {
        self.facts.docked || self.contact_watch.stands_on_dock()
    }

    /// Whether the job needs charge, did not get any because of the dock or of a person, and is on the contacts now.
    pub(super) fn gets_charge_at_last(&self) -> bool {
        let needs_charge = match self.reason {
            Reason::NoChargeCurrent => self.facts.charge_flow == Some(ChargeFlow::Flowing),
            Reason::PushedOff | Reason::LiftedOff => true,
            reason => is_dock_trouble(reason),
        };
        needs_charge && self.facts.docked && !self.facts.wheel_drop
    }

    /// Whether the job needs charge and stands before a dock that was silent and sends beams again.
    pub(super) fn hears_dock_again(&self) -> bool {
        self.reason == Reason::NoBeam && self.contact_watch.receives() && !self.facts.wheel_drop
    }

    /// Whether the robot waits on the contacts for current.
    pub(super) fn waits_for_current(&self) -> bool {
        self.mode == Mode::Working && self.contacts_us.is_some()
    }

    /// The pack charges at last, after a time without current.
    pub(super) fn watch_dry_dock(&mut self, context: &mut TaskContext) {
        if self.reason == Reason::NoChargeCurrent && self.facts.charge_flow == Some(ChargeFlow::Flowing) {
            self.enter(Mode::Docked, Reason::Docked, context);
        }
    }

    fn is_leaving(&self) -> bool {
        self.job
            .as_ref()
            .is_some_and(crate::behavior::job::Job::is_departing)
    }
}

/// Whether this is what the robot says of contacts that lost their voltage under it.
pub(super) fn is_loss(reason: Reason) -> bool {
    matches!(reason, Reason::DockPowerLost | Reason::DockContactLost)
}

/// Whether a way home ends for this reason at the dock or on the way there.
fn is_dock_trouble(reason: Reason) -> bool {
    matches!(
        reason,
        Reason::DockNoContact
            | Reason::DockObstructed
            | Reason::NoBeam
            | Reason::WayBlocked
            | Reason::DockNotFound
    )
}
