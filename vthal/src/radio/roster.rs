//! Which beacons count, and their numbers.

use super::BEACONS_MAX;
use super::reading::BeaconName;

/// Names with their numbers: those of the configuration in its order, or else all in the order in which they were received
/// first, so that a beacon keeps its number as long as the daemon runs.
#[derive(Debug)]
pub(super) struct Roster {
    names: Vec<BeaconName>,
    entry: Admission,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Admission {
    Listed,
    Anybody,
}

/// The number of a beacon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BeaconNumber {
    Known(u16),
    /// Heard for the first time.
    New(u16),
    /// Not one of those that count.
    Stranger,
}

impl Roster {
    /// With these beacons, or with any if there are none.
    pub(super) fn new(listed: &[BeaconName]) -> Self {
        Self {
            names: listed.to_vec(),
            entry: if listed.is_empty() {
                Admission::Anybody
            } else {
                Admission::Listed
            },
        }
    }

    /// The number of the beacon with this name.
    pub(super) fn place(&mut self, name: &BeaconName) -> BeaconNumber {
        let number = |index: usize| u16::try_from(index).ok();
        let known = self.names.iter().position(|known| known == name);
        if let Some(known) = known.and_then(number) {
            return BeaconNumber::Known(known);
        }
        let next = number(self.names.len());
        match next.filter(|_| self.entry == Admission::Anybody && self.names.len() < BEACONS_MAX) {
            Some(next) => {
                self.names.push(name.clone());
                BeaconNumber::New(next)
            }
            None => BeaconNumber::Stranger,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::reading::BeaconName;
    use super::{BEACONS_MAX, BeaconNumber, Roster};

    fn name(text: &str) -> BeaconName {
        BeaconName::new(text).unwrap()
    }

    #[test]
    fn beacons_keep_the_number_of_their_first_word() {
        let mut roster = Roster::new(&[]);
        assert_eq!(roster.place(&name("b")), BeaconNumber::New(0));
        assert_eq!(roster.place(&name("a")), BeaconNumber::New(1));
        assert_eq!(roster.place(&name("b")), BeaconNumber::Known(0));
        for number in 2..BEACONS_MAX {
            assert_ne!(roster.place(&name(&number.to_string())), BeaconNumber::Stranger);
        }
        assert_eq!(roster.place(&name("late")), BeaconNumber::Stranger);
        assert_eq!(roster.place(&name("a")), BeaconNumber::Known(1));
    }

    #[test]
    fn where_beacons_are_listed_the_neighbours_do_not_count() {
        let mut roster = Roster::new(&[name("hall"), name("kitchen")]);
        assert_eq!(roster.place(&name("kitchen")), BeaconNumber::Known(1));
        assert_eq!(roster.place(&name("theirs")), BeaconNumber::Stranger);
    }
}
