//! S6: a press brakes at once, and only motion away from the pressed side is allowed until it is released.
//! S7: a bumper that stays pressed for 3 s or 0.15 m while the robot backs off, or for 10 s while somebody may move the robot off the dock, is
//! stuck; that is latched. A robot at rest may stand against a wall. No sensor looks backwards, so a contact that opens and closes again does not restart the distance: only
//! driving forward reduces it.

use rvac_protocol::message::Bumpers;
use rvac_units::Tick;

use crate::rules::bumper::{RELEASE_MS, STUCK_BACKING_MS, STUCK_BACKING_NM, STUCK_MS};
use crate::timing::{Debounced, HoldTimer};

/// State of the bumper rules.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BumperRule {
    left: Debounced<0, RELEASE_MS>,
    right: Debounced<0, RELEASE_MS>,
    pressed: HoldTimer,
    backing: HoldTimer,
    /// Distance reversed while pressed, less the distance driven forward since.
    backed_nm: i64,
}

/// What the robot does while the bumper is looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BumperContext {
    /// The wheels together drive the robot backwards.
    pub(crate) backing: bool,
    /// Distance of the robot's centre since the last pass, forward positive.
    pub(crate) travelled_nm: i32,
    /// Nobody has armed, or the robot is on the dock, which may press the bumper permanently.
    pub(crate) at_rest: bool,
}

impl BumperRule {
    /// Takes the raw switches; returns whether the bumper is stuck.
    pub(crate) fn update(&mut self, raw: Bumpers, context: BumperContext, now: Tick) -> bool {
        let left = self.left.update(raw.left, now);
        let right = self.right.update(raw.right, now);
        let pressed = left || right;
        let stuck_anyhow = self
            .pressed
            .for_at_least(pressed && !context.at_rest, now, STUCK_MS);
        let stuck_backing = self
            .backing
            .for_at_least(pressed && context.backing, now, STUCK_BACKING_MS);
        self.measure(pressed, context);
        let stuck_far = pressed && self.backed_nm > STUCK_BACKING_NM;
        stuck_anyhow || stuck_backing || stuck_far
    }

    /// A robot that is pushed back by its bumper with the wheels at rest is not backing off.
    const fn measure(&mut self, pressed: bool, context: BumperContext) {
        if context.travelled_nm > 0 || (pressed && context.backing) {
            let backed_nm = self.backed_nm.saturating_sub(context.travelled_nm as i64);
            self.backed_nm = if backed_nm < 0 { 0 } else { backed_nm };
        }
    }

    /// A person has freed the bumper: the distance counts from here.
    pub(crate) const fn reset_backed_distance(&mut self) {
        self.backed_nm = 0;
    }

    /// Zones that count as pressed.
    pub(crate) const fn pressed(&self) -> Bumpers {
        Bumpers {
            left: self.left.is_active(),
            right: self.right.is_active(),
        }
    }

    /// Whether any zone counts as pressed.
    pub(crate) const fn any(&self) -> bool {
        self.left.is_active() || self.right.is_active()
    }
}
