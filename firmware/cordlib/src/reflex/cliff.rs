//! S8: a cliff stops the robot; then it may only reverse, slowly and not far. Three cliffs within 5 s, or a reverse that
//! does not clear it, is a trap; that is latched.

use rvac_protocol::message::Cliffs;
use rvac_units::Tick;

use crate::rules::cliff::{CLEAR_MS, ONSETS_MAX, ONSETS_WINDOW_MS, REVERSE_MAX_NM, SAME_CLIFF_MS, SET_MS};
use crate::timing::Debounced;

/// State of the cliff rule.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CliffRule {
    left: Debounced<SET_MS, CLEAR_MS>,
    middle: Debounced<SET_MS, CLEAR_MS>,
    right: Debounced<SET_MS, CLEAR_MS>,
    reversed_nm: i64,
    onsets: [Option<Tick>; ONSETS_MAX as usize],
}

/// The robot's motion when the sensors are read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CliffContext {
    /// The wheels are driven. Only then an onset counts towards `cliff-trapped`: a carried robot sees cliffs too.
    pub(crate) driven: bool,
    /// Distance of the robot's centre since the last pass, forward positive.
    pub(crate) travelled_nm: i32,
}

impl CliffRule {
    /// Takes the sensors' readings; returns whether the robot is trapped.
    pub(crate) fn update(&mut self, no_floor: Cliffs, context: CliffContext, now: Tick) -> bool {
        let before = self.any();
        self.left.update(no_floor.left, now);
        self.middle.update(no_floor.middle, now);
        self.right.update(no_floor.right, now);
        if !self.any() {
            return false;
        }
        if !before && !self.is_same_cliff(now) {
            self.reversed_nm = 0;
            if context.driven && self.is_third_onset(now) {
                return true;
            }
        }
        let travelled_nm = i64::from(context.travelled_nm);
        self.reversed_nm = self.reversed_nm.saturating_sub(travelled_nm).max(0);
        self.reversed_nm > REVERSE_MAX_NM
    }

    /// Sensors that count as seeing no floor.
    pub(crate) const fn seen(&self) -> Cliffs {
        Cliffs {
            left: self.left.is_active(),
            middle: self.middle.is_active(),
            right: self.right.is_active(),
        }
    }

    /// Whether any sensor counts as seeing no floor.
    pub(crate) const fn any(&self) -> bool {
        self.left.is_active() || self.middle.is_active() || self.right.is_active()
    }

    /// Whether an onset now belongs to the last cliff. A flicker that goes on counts again after that time.
    fn is_same_cliff(&self, now: Tick) -> bool {
        let is_fresh = |onset: &Tick| now.since(*onset) <= SAME_CLIFF_MS;
        self.onsets.iter().flatten().any(is_fresh)
    }

    /// Notes an onset; true if it is the third within the window. The count then starts anew.
    fn is_third_onset(&mut self, now: Tick) -> bool {
        for place in &mut self.onsets {
            if place.is_some_and(|at| now.since(at) > ONSETS_WINDOW_MS) {
                *place = None;
            }
        }
        if let Some(place) = self.onsets.iter_mut().find(|place| place.is_none()) {
            *place = Some(now);
        }
        let trapped = self.onsets.iter().all(Option::is_some);
        if trapped {
            self.onsets = [None; ONSETS_MAX as usize];
        }
        trapped
    }
}
