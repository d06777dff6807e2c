//! Counts what fails at the dock, so that docking ends after a few tries and names the reason.

use super::parameters::TRIES;
use crate::model::reason::Reason;

/// How a drive in to the dock failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FailedTry {
    /// It touched the dock, and the contacts did not close.
    NoContact,
    /// Something stood in front of the dock.
    Obstructed,
    /// It drove past where the contacts should be and touched nothing.
    Passed,
}

/// What has failed in this task.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FailedTries {
    no_contact: u32,
    obstructed: u32,
    passed: u32,
    silent: u32,
    blocked: u32,
    is_late: bool,
    is_shut_off: bool,
}

impl FailedTries {
    pub(super) fn count(&mut self, failed: FailedTry) {
        match failed {
            FailedTry::NoContact => self.no_contact += 1,
            FailedTry::Obstructed => self.obstructed += 1,
            FailedTry::Passed => self.passed += 1,
        }
    }

    /// No beam was received at the dock of the map, so long after the way there was blocked first. A robot whose way was blocked again and
    /// again and that hears nothing at last took the room on this side of a shut door for the one beyond.
    pub(super) fn count_silent(&mut self, since_blocked_s: Option<f64>) {
        self.silent += 1;
        let was_blocked_for_long = since_blocked_s.is_some_and(|since_s| since_s >= TRIES.blocked_max_s);
        self.is_shut_off |= was_blocked_for_long && self.blocked > 1;
    }

    /// No path to the dock of the map was left, so long after that happened first.
    pub(super) fn count_blocked(&mut self, since_first_s: f64) {
        self.blocked += 1;
        self.is_shut_off |= since_first_s >= TRIES.blocked_max_s;
    }

    /// Whether that has happened.
    pub(super) const fn was_blocked(&self) -> bool {
        self.blocked > 0
    }

    /// Whether that happened an even number of times.
    pub(super) const fn is_blocked_evenly(&self) -> bool {
        self.blocked.is_multiple_of(2)
    }

    /// No try is under way, so long after the robot stood before the dock of the map first.
    pub(super) fn between_tries(&mut self, at_dock_s: f64) {
        self.is_late = at_dock_s >= TRIES.at_dock_max_s;
    }

    /// Why docking ends, once enough has failed, or once something has failed and the robot has been at the dock for too long.
    pub(super) fn verdict(&self) -> Option<Reason> {
        let drives_in = self.no_contact + self.obstructed + self.passed;
        let all = drives_in + self.silent;
        if all >= TRIES.all_max || (self.is_late && all > 0) {
            Some(match drives_in {
                0 => Reason::NoBeam,
                _ if self.obstructed > self.no_contact => Reason::DockObstructed,
                _ => Reason::DockNoContact,
            })
        } else if self.blocked >= TRIES.blocked_max || self.is_shut_off {
            Some(Reason::WayBlocked)
        } else if self.silent >= TRIES.silent_max && drives_in == 0 {
            Some(Reason::NoBeam)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{FailedTries, FailedTry, TRIES};
    use crate::model::reason::Reason;

    fn tries(failed: &[(FailedTry, u32)], silent: u32) -> FailedTries {
        let mut tries = FailedTries::default();
        for (what, times) in failed {
            (0..*times).for_each(|_| tries.count(*what));
        }
        (0..silent).for_each(|_| tries.count_silent(None));
        tries
    }

    #[test]
    fn the_verdict_names_what_failed_most() {
        use FailedTry::{NoContact, Obstructed, Passed};
        for (failed, silent, reason) in [
            (vec![(NoContact, 3), (Obstructed, 1)], 0, None),
            (vec![(NoContact, 5)], 0, Some(Reason::DockNoContact)),
            (
                vec![(NoContact, 2), (Obstructed, 3)],
                0,
                Some(Reason::DockObstructed),
            ),
            (vec![(Passed, 4)], 0, None),
            (vec![(Passed, 5)], 0, Some(Reason::DockNoContact)),
            (vec![], 3, None),
            (vec![], 4, Some(Reason::NoBeam)),
            // A dock that was heard once is not silent: what stands before it hides it.
            (vec![(Obstructed, 1)], 3, None),
            (vec![(Obstructed, 1)], 4, Some(Reason::DockObstructed)),
            (vec![(NoContact, 1)], 4, Some(Reason::DockNoContact)),
        ] {
            assert_eq!(tries(&failed, silent).verdict(), reason, "{failed:?} {silent}");
        }
    }

    #[test]
    fn what_takes_too_long_at_the_dock_ends_as_soon_as_something_failed() {
        let verdict = |failed: &[(FailedTry, u32)], silent, at_dock_s| {
            let mut tries = tries(failed, silent);
            tries.between_tries(at_dock_s);
            tries.verdict()
        };
        let late_s = TRIES.at_dock_max_s;
        assert_eq!(verdict(&[], 0, late_s), None);
        assert_eq!(verdict(&[], 1, late_s - 1.0), None);
        assert_eq!(verdict(&[], 1, late_s), Some(Reason::NoBeam));
        let obstructed = [(FailedTry::Obstructed, 1)];
        assert_eq!(verdict(&obstructed, 2, late_s), Some(Reason::DockObstructed));
    }

    #[test]
    fn a_dock_that_no_path_leads_to_ends_it_as_well() {
        let mut tries = FailedTries::default();
        (0..3).for_each(|_| tries.count_blocked(0.0));
        assert_eq!(tries.verdict(), None);
        tries.count_blocked(0.0);
        assert_eq!(tries.verdict(), Some(Reason::WayBlocked));
    }

    #[test]
    fn a_dock_that_is_shut_off_for_minutes_ends_it_at_the_next_attempt() {
        let mut tries = FailedTries::default();
        tries.count_blocked(0.0);
        tries.count_blocked(TRIES.blocked_max_s - 1.0);
        assert_eq!(tries.verdict(), None);
        tries.count_blocked(TRIES.blocked_max_s);
        assert_eq!(tries.verdict(), Some(Reason::WayBlocked));
    }

    #[test]
    fn silence_after_a_way_that_was_blocked_again_and_again_is_no_silent_dock() {
        let heard_nothing_after = |blocked: u32, since_s| {
            let mut tries = FailedTries::default();
            (0..blocked).for_each(|_| tries.count_blocked(0.0));
            tries.count_silent(Some(since_s));
            tries.verdict()
        };
        let long_s = TRIES.blocked_max_s;
        assert_eq!(heard_nothing_after(2, long_s), Some(Reason::WayBlocked));
        assert_eq!(heard_nothing_after(2, long_s - 1.0), None);
        assert_eq!(
            heard_nothing_after(1, long_s),
            None,
            "somebody stood in the way once"
        );
    }
}
