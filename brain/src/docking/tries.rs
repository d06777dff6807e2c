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
}

impl FailedTries {
    pub(super) fn count(&mut self, failed: FailedTry) {
        match failed {
            FailedTry::NoContact => self.no_contact += 1,
            FailedTry::Obstructed => self.obstructed += 1,
            FailedTry::Passed => self.passed += 1,
        }
    }

    /// No beam was received at the dock of the map.
    pub(super) fn count_silent(&mut self) {
        self.silent += 1;
    }

    /// No path to the dock of the map was left.
    pub(super) fn count_blocked(&mut self) {
        self.blocked += 1;
    }

    /// Whether that has happened.
    pub(super) const fn was_blocked(&self) -> bool {
        self.blocked > 0
    }

    /// Whether that happened an even number of times.
    pub(super) const fn is_blocked_evenly(&self) -> bool {
        self.blocked.is_multiple_of(2)
    }

    /// Why docking ends, once enough has failed.
    pub(super) fn verdict(&self) -> Option<Reason> {
        let all = self.no_contact + self.obstructed + self.passed;
        if self.no_contact >= TRIES.contact_max {
            Some(Reason::DockNoContact)
        } else if self.obstructed >= TRIES.contact_max {
            Some(Reason::DockObstructed)
        } else if all >= TRIES.all_max {
            Some(if self.obstructed > self.no_contact {
                Reason::DockObstructed
            } else {
                Reason::DockNoContact
            })
        } else if self.silent >= TRIES.silent_max {
            Some(Reason::NoBeam)
        } else if self.blocked >= TRIES.blocked_max {
            Some(Reason::WayBlocked)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{FailedTries, FailedTry};
    use crate::model::reason::Reason;

    fn verdict(failed: &[(FailedTry, u32)]) -> Option<Reason> {
        let mut tries = FailedTries::default();
        for (what, times) in failed {
            (0..*times).for_each(|_| tries.count(*what));
        }
        tries.verdict()
    }

    #[test]
    fn the_verdict_names_what_failed_most() {
        use FailedTry::{NoContact, Obstructed, Passed};
        for (failed, reason) in [
            (vec![(NoContact, 4), (Obstructed, 3)], None),
            (vec![(NoContact, 5)], Some(Reason::DockNoContact)),
            (
                vec![(NoContact, 4), (Obstructed, 5)],
                Some(Reason::DockObstructed),
            ),
            (vec![(Passed, 9)], None),
            (vec![(Passed, 9), (NoContact, 1)], Some(Reason::DockNoContact)),
        ] {
            assert_eq!(verdict(&failed), reason, "{failed:?}");
        }
    }

    #[test]
    fn a_silent_or_blocked_dock_ends_it_as_well() {
        let mut tries = FailedTries::default();
        (0..4).for_each(|_| tries.count_silent());
        assert_eq!(tries.verdict(), Some(Reason::NoBeam));
        let mut tries = FailedTries::default();
        (0..4).for_each(|_| tries.count_blocked());
        assert_eq!(tries.verdict(), Some(Reason::WayBlocked));
    }
}
