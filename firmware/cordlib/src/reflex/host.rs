//! What the host allows: S4 (`arm` after a reset), `stop`, S1 (an expired lease), S28 (a button press outranks the host, S27,
//! until it arms again).

use rvac_protocol::message::{Inhibit, Inhibits};

use crate::guarded::Permission;

/// Permissions given by the host. Nothing is allowed at first.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HostRule {
    armed: Permission,
    inhibits: Inhibits,
}

impl HostRule {
    /// Allows motion; an earlier `stop`, button press and lost link are cleared.
    pub(crate) const fn arm(&mut self) {
        self.armed = Permission::GIVEN;
        self.inhibits = Inhibits::NONE;
    }

    /// Motion must be armed anew.
    pub(crate) const fn disarm(&mut self) {
        self.armed = Permission::REFUSED;
    }

    /// `stop` was commanded.
    pub(crate) const fn stop(&mut self) {
        self.inhibits.insert(Inhibit::Stopped);
    }

    /// A person pressed a button while the robot moved.
    pub(crate) const fn button(&mut self) {
        self.inhibits.insert(Inhibit::ButtonStop);
    }

    /// A lease ran out while the robot moved.
    pub(crate) const fn lose_link(&mut self) {
        self.inhibits.insert(Inhibit::LinkLost);
    }

    /// A fresh motion command came: the link is alive.
    pub(crate) const fn hear(&mut self) {
        self.inhibits.remove(Inhibit::LinkLost);
    }

    /// Whether the host has armed.
    pub(crate) const fn is_armed(&self) -> bool {
        self.armed.is_given()
    }

    /// Whether the host has armed and has not stopped the robot since.
    pub(crate) const fn lets_move(&self) -> bool {
        self.armed.is_given() && !self.inhibits.contains(Inhibit::Stopped)
    }

    /// Inhibits that follow.
    pub(crate) const fn inhibits(&self) -> Inhibits {
        let mut inhibits = self.inhibits;
        if !self.armed.is_given() {
            inhibits.insert(Inhibit::NotArmed);
        }
        inhibits
    }
}
