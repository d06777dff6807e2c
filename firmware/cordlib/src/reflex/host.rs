//! What the host allows: S4 (`arm` after a reset), `stop`, S1 (a lease that ran out), S28 (a person's button outranks the
//! host, S27, until it arms again).

use rvac_protocol::message::{Inhibit, Inhibits};

use crate::guarded::Permission;

/// Allowances of the host. Starts with nothing allowed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HostRule {
    armed: Permission,
    standing: Inhibits,
}

impl HostRule {
    /// Motion is allowed; earlier `stop`, button and lost link are forgotten.
    pub(crate) const fn arm(&mut self) {
        self.armed = Permission::GIVEN;
        self.standing = Inhibits::NONE;
    }

    /// Motion must be armed anew.
    pub(crate) const fn disarm(&mut self) {
        self.armed = Permission::REFUSED;
    }

    /// `stop` was commanded.
    pub(crate) const fn stop(&mut self) {
        self.standing.insert(Inhibit::Stopped);
    }

    /// A person pressed a button while the robot moved.
    pub(crate) const fn button(&mut self) {
        self.standing.insert(Inhibit::ButtonStop);
    }

    /// A lease ran out while the robot moved.
    pub(crate) const fn lose_link(&mut self) {
        self.standing.insert(Inhibit::LinkLost);
    }

    /// A fresh motion command came: the link lives.
    pub(crate) const fn hear(&mut self) {
        self.standing.remove(Inhibit::LinkLost);
    }

    /// Whether the host has armed.
    pub(crate) const fn is_armed(&self) -> bool {
        self.armed.is_given()
    }

    /// Whether the host has armed and not stopped everything since, which takes another `arm` to move.
    pub(crate) const fn lets_move(&self) -> bool {
        self.armed.is_given() && !self.standing.contains(Inhibit::Stopped)
    }

    /// What follows from it.
    pub(crate) const fn inhibits(&self) -> Inhibits {
        let mut inhibits = self.standing;
        if !self.armed.is_given() {
            inhibits.insert(Inhibit::NotArmed);
        }
        inhibits
    }
}
