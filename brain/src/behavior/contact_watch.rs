//! What has happened to a robot on its dock whose contacts lose their voltage.
//!
//! The voltage alone says little: the mains may be gone, a contact may be dirty, or somebody took the robot away. Wheels, gyro and wheel
//! drop say whether it still stands there, and the dock's beams say whether the dock has power. Contacts flicker, so nothing is judged
//! before they have been open for a while.

use super::facts::Facts;
use crate::behavior::parameters::CONTACTS;
use crate::model::advance::Advance;
use crate::model::reason::Reason;

/// Follows the contacts, and the robot's motion just before they open and while they are open.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactWatch {
    opened_us: Option<u64>,
    closed_us: u64,
    moving_us: u64,
    moved_m: f64,
    turned_rad: f64,
    is_moved: bool,
    is_lifted: bool,
    switch: WheelDropSwitch,
    /// The dock's beams were received while the contacts were closed.
    received_on_contacts: bool,
    receives: bool,
    /// Losses of contact since the robot was last moved.
    losses: u32,
}

/// The switch of a wheel that hangs. One that hangs for long on closed contacts sticks: who lifts the robot opens them.
#[derive(Clone, Copy, Debug, Default)]
struct WheelDropSwitch {
    hangs_us: Option<u64>,
    sticks: bool,
}

impl WheelDropSwitch {
    fn follow(&mut self, facts: &Facts) {
        if !facts.wheel_drop {
            *self = Self::default();
        } else if facts.docked {
            let since_us = *self.hangs_us.get_or_insert(facts.now_us);
            self.sticks |= facts.now_us.saturating_sub(since_us) > CONTACTS.sticks_us;
        } else {
            self.hangs_us = None;
        }
    }

    /// Whether it says that somebody holds the robot.
    const fn tells_lift(self, facts: &Facts) -> bool {
        facts.wheel_drop && !self.sticks
    }
}

impl ContactWatch {
    /// Follows one step.
    pub(super) fn follow(&mut self, facts: &Facts, advance: &Advance, receives_dock: bool) {
        self.receives = receives_dock;
        self.switch.follow(facts);
        self.sense_motion(facts, advance);
        if !facts.docked {
            self.opened_us.get_or_insert(facts.now_us);
            return;
        }
        if self.opened_us.take().is_some() {
            let losses = if self.closed_us == 0 || self.is_moved {
                0
            } else {
                self.losses.saturating_add(1)
            };
            *self = Self {
                closed_us: facts.now_us,
                moving_us: facts.now_us,
                losses,
                switch: self.switch,
                receives: receives_dock,
                ..Self::default()
            };
        }
        self.received_on_contacts |= receives_dock;
        let is_at_rest = facts.now_us.saturating_sub(self.moving_us) > CONTACTS.at_rest_us;
        if is_at_rest && !self.switch.tells_lift(facts) {
            (self.moved_m, self.turned_rad) = (0.0, 0.0);
            (self.is_moved, self.is_lifted) = (false, false);
        }
    }

    fn sense_motion(&mut self, facts: &Facts, advance: &Advance) {
        let gyro_rad = advance.gyro_turn_rad.unwrap_or(0.0);
        // A slower turn is the bias of the gyro.
        let is_turning = gyro_rad.abs() > CONTACTS.turning_rad_per_s * advance.time_s;
        if advance.distance_m != 0.0 || advance.wheel_turn_rad != 0.0 || is_turning {
            self.moving_us = facts.now_us;
        }
        self.is_lifted |= self.switch.tells_lift(facts);
        self.moved_m += advance.distance_m;
        self.turned_rad += if is_turning {
            gyro_rad
        } else {
            advance.wheel_turn_rad
        };
        self.is_moved |= self.is_lifted
            || self.moved_m.abs() > CONTACTS.moved_m
            || self.turned_rad.abs() > CONTACTS.turned_rad;
    }

    /// Whether nobody has moved the robot since the contacts opened.
    pub(super) fn stands_on_dock(&self) -> bool {
        self.opened_us.is_some() && self.closed_us > 0 && !self.is_moved
    }

    /// What happened, once the contacts have been open long enough to tell.
    pub(super) fn loss(&self, now_us: u64) -> Option<Reason> {
        let open_us = now_us.saturating_sub(self.opened_us?);
        if open_us < CONTACTS.judged_after_us {
            return None;
        }
        Some(if self.is_lifted {
            Reason::LiftedOff
        } else if self.is_moved {
            Reason::PushedOff
        } else if self.received_on_contacts && !self.receives {
            Reason::DockPowerLost
        } else {
            Reason::DockContactLost
        })
    }

    /// Whether the contacts are closed for good. After each loss they must hold for longer, until somebody moves the robot.
    pub(super) fn is_closed_for_good(&self, now_us: u64) -> bool {
        if self.opened_us.is_some() {
            return false;
        }
        let doublings = self.losses.saturating_sub(1).min(CONTACTS.doublings_max);
        let hold_us = CONTACTS.holds_us << doublings;
        self.losses == 0 || now_us.saturating_sub(self.closed_us) >= hold_us
    }

    /// Since when they are open, microseconds.
    pub(super) fn opened_us(&self) -> Option<u64> {
        self.opened_us
    }

    /// Whether the dock sends beams, so that it has power.
    pub(super) fn receives(&self) -> bool {
        self.receives
    }
}
