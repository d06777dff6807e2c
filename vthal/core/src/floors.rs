//! The floors of the home: each has a map of its own, and is kept by the shell with all its versions.

use brain::{NextNumbers, RoomName, StoredMap};
use rvac_api::FloorView;

/// Free floor of a map, in square metres.
fn area_m2(home: &StoredMap) -> f64 {
    let knowledge = home.knowledge();
    let free = knowledge.values().iter();
    let count = free.filter(|kind| **kind == brain::CellKnowledge::Free).count();
    count as f64 * brain::CELL_M * brain::CELL_M
}

/// A floor as it is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptFloor {
    /// Its number, from 1; no other floor gets it while this one is kept.
    pub number: u16,
    /// What people call it.
    pub name: Option<RoomName>,
    /// The newest version of its map, once there is one.
    pub home: Option<StoredMap>,
    /// Whether a person has removed it: it is kept, and can come back.
    pub removed: bool,
    /// What is new on it gets these numbers or higher ones, also when no map of it can be read any more.
    pub next_numbers: NextNumbers,
}

impl KeptFloor {
    /// A floor of which nothing is known yet.
    #[must_use]
    pub const fn new(number: u16) -> Self {
        Self {
            number,
            name: None,
            home: None,
            removed: false,
            next_numbers: NextNumbers::FIRST,
        }
    }

    /// What to call it in a sentence.
    #[must_use]
    pub fn title(&self) -> String {
        match &self.name {
            Some(name) => name.as_str().to_owned(),
            None => format!("floor {}", self.number),
        }
    }

    fn view(&self) -> FloorView {
        let home = self.home.as_ref();
        FloorView {
            number: self.number,
            name: self.name.as_ref().map(|name| name.as_str().to_owned()),
            area_m2: home.map_or(0.0, area_m2),
            rooms: home.map_or(0, |home| u32::try_from(home.room_count()).unwrap_or(u32::MAX)),
            has_dock: home.is_some_and(|home| home.dock().is_some()),
            removed: self.removed,
        }
    }
}

/// All floors, by their numbers. There is always one at least that is not removed.
#[derive(Clone, Debug)]
pub(crate) struct Floors {
    floors: Vec<KeptFloor>,
    /// As clients receive them; rebuilt when something changes.
    views: Vec<FloorView>,
}

impl Floors {
    pub(crate) fn new(mut floors: Vec<KeptFloor>) -> Self {
        if floors.iter().all(|floor| floor.removed) {
            let free = (1..=u16::MAX).find(|number| floors.iter().all(|floor| floor.number != *number));
            floors.push(KeptFloor::new(free.unwrap_or(u16::MAX)));
        }
        floors.sort_by_key(|floor| floor.number);
        let views = floors.iter().map(KeptFloor::view).collect();
        Self { floors, views }
    }

    /// The floors as the shell keeps them now. Maps that it may not have written yet are the newer ones.
    pub(crate) fn renew(&mut self, floors: Vec<KeptFloor>) {
        let newer = |floor: KeptFloor| KeptFloor {
            home: floor
                .home
                .map(|home| self.home(floor.number).cloned().unwrap_or(home)),
            ..floor
        };
        *self = Self::new(floors.into_iter().map(newer).collect());
    }

    pub(crate) fn views(&self) -> &[FloorView] {
        &self.views
    }

    /// Those that are not removed.
    pub(crate) fn present(&self) -> impl Iterator<Item = &KeptFloor> {
        self.floors.iter().filter(|floor| !floor.removed)
    }

    /// One that is not removed.
    pub(crate) fn get(&self, number: u16) -> Option<&KeptFloor> {
        self.present().find(|floor| floor.number == number)
    }

    /// One that is removed.
    pub(crate) fn is_removed(&self, number: u16) -> bool {
        self.floors
            .iter()
            .any(|floor| floor.removed && floor.number == number)
    }

    /// The maps of those that are not removed and have one.
    pub(crate) fn homes(&self) -> impl Iterator<Item = (u16, &StoredMap)> {
        self.present()
            .filter_map(|floor| Some((floor.number, floor.home.as_ref()?)))
    }

    pub(crate) fn home(&self, number: u16) -> Option<&StoredMap> {
        self.get(number)?.home.as_ref()
    }

    /// The numbers of what is new on the first floor, when no floor has a map.
    pub(crate) fn next_numbers_without_maps(&self) -> Option<NextNumbers> {
        let first = self.present().next()?;
        self.homes().next().is_none().then_some(first.next_numbers)
    }

    /// The lowest number that is not removed.
    pub(crate) fn first(&self) -> u16 {
        self.present().next().map_or(1, |floor| floor.number)
    }

    /// A floor has a newer map.
    pub(crate) fn take_home(&mut self, number: u16, home: &StoredMap) {
        let floors = self.floors.iter_mut().zip(&mut self.views);
        for (floor, view) in floors.filter(|(floor, _)| floor.number == number) {
            floor.home = Some(home.clone());
            *view = floor.view();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Floors, KeptFloor};

    #[test]
    fn there_is_always_a_floor_to_be_on_and_it_takes_no_number_of_a_removed_one() {
        assert_eq!(Floors::new(Vec::new()).first(), 1);
        let removed = KeptFloor {
            removed: true,
            ..KeptFloor::new(1)
        };
        let floors = Floors::new(vec![removed]);
        assert_eq!(floors.first(), 2);
        assert!(floors.is_removed(1) && floors.get(1).is_none());
    }
}
