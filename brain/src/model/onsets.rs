//! What begins with an observation: the one place where the brain compares the sensors with those of the observation before.

use super::observation::{Cliffs, Contacts, Observation};

/// What begins with one observation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Onsets {
    /// Zones of the bumper that are pressed while none was before. A second zone belongs to the same contact.
    pub contacts: Contacts,
    /// Cliff sensors that have just lost the floor.
    pub cliffs: Cliffs,
    /// No cliff sensor had lost the floor before, and one has now.
    pub is_first_cliff: bool,
    /// A cliff holds the robot, by its sensors or by an inhibit of the firmware, and none did before.
    pub is_held_by_cliff: bool,
    /// How the robot came to be on the dock, if it was not on it before.
    pub docking: Option<DockOnset>,
}

/// How a robot came to be on its dock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DockOnset {
    /// The first observation shows it there.
    Awoken,
    /// The contacts of the dock have closed.
    Arrived,
}

/// Levels of an observation whose onsets matter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Levels {
    contacts: Contacts,
    cliffs: Cliffs,
    is_at_cliff: bool,
    docked: bool,
}

/// Derives onsets from one observation after the other.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OnsetDetector {
    /// Of the last observation; `None` = there was none.
    before: Option<Levels>,
}

impl OnsetDetector {
    /// Takes the next observation. What the first one shows begins with it.
    pub(crate) fn take(&mut self, observation: &Observation) -> Onsets {
        let now = Levels {
            contacts: observation.contacts,
            cliffs: observation.cliffs,
            is_at_cliff: observation.is_at_cliff(),
            docked: observation.docked,
        };
        let is_first = self.before.is_none();
        let before = self.before.replace(now).unwrap_or_default();
        let docking = if is_first {
            DockOnset::Awoken
        } else {
            DockOnset::Arrived
        };
        Onsets {
            contacts: if before.contacts.any() {
                Contacts::default()
            } else {
                now.contacts
            },
            cliffs: Cliffs {
                left: now.cliffs.left && !before.cliffs.left,
                middle: now.cliffs.middle && !before.cliffs.middle,
                right: now.cliffs.right && !before.cliffs.right,
            },
            is_first_cliff: now.cliffs.any() && !before.cliffs.any(),
            is_held_by_cliff: now.is_at_cliff && !before.is_at_cliff,
            docking: (now.docked && !before.docked).then_some(docking),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DockOnset, OnsetDetector, Onsets};
    use crate::model::observation::{Cliffs, Contacts, Observation};

    fn felt(contacts: [bool; 2], cliffs: [bool; 3], docked: bool) -> Observation {
        Observation {
            contacts: Contacts {
                left: contacts[0],
                right: contacts[1],
            },
            cliffs: Cliffs {
                left: cliffs[0],
                middle: cliffs[1],
                right: cliffs[2],
            },
            docked,
            ..Observation::default()
        }
    }

    #[test]
    fn a_contact_begins_once_whatever_its_zones_do() {
        let mut detector = OnsetDetector::default();
        let mut begins = |left, right| {
            let observation = felt([left, right], [false; 3], false);
            detector.take(&observation).contacts
        };
        let none = Contacts::default();
        let left = Contacts { left: true, ..none };
        let right = Contacts { right: true, ..none };
        assert_eq!(begins(true, false), left);
        assert_eq!(begins(true, true), none, "the same contact");
        assert_eq!(begins(false, true), none, "still");
        assert_eq!(begins(false, false), none);
        assert_eq!(begins(false, true), right);
    }

    #[test]
    fn each_cliff_sensor_begins_and_the_first_of_them_is_known() {
        let mut detector = OnsetDetector::default();
        let mut take = |cliffs| detector.take(&felt([false; 2], cliffs, false));
        let first = take([true, false, false]);
        assert!(first.cliffs.left && first.is_first_cliff && first.is_held_by_cliff);
        let second = take([true, true, false]);
        assert!(second.cliffs.middle && !second.cliffs.left);
        assert!(!second.is_first_cliff && !second.is_held_by_cliff);
        assert_eq!(take([false; 3]), Onsets::default());
    }

    #[test]
    fn a_robot_that_wakes_on_its_dock_has_not_docked() {
        let mut detector = OnsetDetector::default();
        let mut docking = |docked| detector.take(&felt([false; 2], [false; 3], docked)).docking;
        assert_eq!(docking(true), Some(DockOnset::Awoken));
        assert_eq!(docking(true), None);
        assert_eq!(docking(false), None);
        assert_eq!(docking(true), Some(DockOnset::Arrived));
    }
}
