//! Which beacons count, and their numbers.
//!
//! The home remembers its beacons by number, so a beacon has the same one in each life of the daemon: it comes from the name.

use super::BEACONS_MAX;
use super::reading::BeaconName;

/// Names with their numbers: those of the configuration, or else all in the order in which they were received first.
#[derive(Debug)]
pub(super) struct Roster {
    names: Vec<(BeaconName, u16)>,
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
        let mut roster = Self {
            names: Vec::new(),
            entry: if listed.is_empty() {
                Admission::Anybody
            } else {
                Admission::Listed
            },
        };
        for name in listed {
            roster.add(name);
        }
        roster
    }

    /// The number of the beacon with this name.
    pub(super) fn place(&mut self, name: &BeaconName) -> BeaconNumber {
        if let Some((_, number)) = self.names.iter().find(|(known, _)| known == name) {
            return BeaconNumber::Known(*number);
        }
        if self.entry == Admission::Anybody && self.names.len() < BEACONS_MAX {
            BeaconNumber::New(self.add(name))
        } else {
            BeaconNumber::Stranger
        }
    }

    /// Gives a name its number: that of the name, or the next that is free.
    fn add(&mut self, name: &BeaconName) -> u16 {
        let mut number = number_of(name.as_str());
        while self.names.iter().any(|(_, taken)| *taken == number) {
            number = number.wrapping_add(1);
        }
        self.names.push((name.clone(), number));
        number
    }
}

/// A number for a name, the same on each machine: FNV-1a of 32 bits, folded.
fn number_of(name: &str) -> u16 {
    let hash = name.bytes().fold(0x811C_9DC5_u32, |hash, byte| {
        (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    });
    ((hash >> 16) ^ hash) as u16
}

#[cfg(test)]
mod tests {
    use super::super::reading::BeaconName;
    use super::{BEACONS_MAX, BeaconNumber, Roster};

    fn name(text: &str) -> BeaconName {
        BeaconName::new(text).unwrap()
    }

    fn new(roster: &mut Roster, text: &str) -> u16 {
        match roster.place(&name(text)) {
            BeaconNumber::New(number) => number,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn beacons_keep_their_numbers_in_whatever_order_they_are_heard() {
        let (mut one, mut other) = (
            Roster::new(&[]),
            Roster::new(&[name("0CA8"), name("b"), name("a")]),
        );
        let (a, b) = (new(&mut one, "a"), new(&mut one, "b"));
        assert_ne!(a, b);
        assert_eq!(one.place(&name("a")), BeaconNumber::Known(a));
        assert_eq!(other.place(&name("a")), BeaconNumber::Known(a), "listed");
        assert_eq!(other.place(&name("b")), BeaconNumber::Known(b));
        assert_eq!(other.place(&name("0CA8")), BeaconNumber::Known(23_838));
        for number in 2..BEACONS_MAX {
            new(&mut one, &number.to_string());
        }
        assert_eq!(one.place(&name("late")), BeaconNumber::Stranger);
        assert_eq!(one.place(&name("b")), BeaconNumber::Known(b));
    }

    #[test]
    fn two_names_of_one_number_stay_two() {
        let mut roster = Roster::new(&[]);
        let numbers: std::collections::BTreeSet<u16> = (0..BEACONS_MAX)
            .map(|number| new(&mut roster, &format!("{number:04X}")))
            .collect();
        assert_eq!(numbers.len(), BEACONS_MAX);
    }

    #[test]
    fn where_beacons_are_listed_the_neighbours_do_not_count() {
        let mut roster = Roster::new(&[name("hall"), name("kitchen")]);
        assert!(matches!(roster.place(&name("kitchen")), BeaconNumber::Known(_)));
        assert_eq!(roster.place(&name("theirs")), BeaconNumber::Stranger);
    }
}
