//! Floors of archives on the disk, and what crashes leave.

use std::fs;

use brain::{Cell, CellKnowledge, Raster, RoomName, StoredMap};
use vthal_core::{FloorTask, KeptFloor};

use super::super::{FLOORS_MAX, FloorFolder};
use super::with_new;
use crate::floor_archive::ArchivedFloor;

struct Scratch(FloorFolder);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("vthal-taking-in-{name}-{}", std::process::id()));
        fs::remove_dir_all(&path).ok();
        Self(FloorFolder::new(path))
    }

    /// A home with a map on its first floor, and an attic.
    fn home(name: &str) -> Self {
        let scratch = Self::new(name);
        scratch.0.maps(1).save(&map(3)).expect("saves");
        scratch.0.change(&FloorTask::New(called("Attic"))).expect("makes");
        scratch
    }

    fn floors(&self) -> Vec<KeptFloor> {
        self.0.load().0
    }

    fn names(&self) -> Vec<Option<String>> {
        let name = |floor: KeptFloor| floor.name.map(|name| name.as_str().to_owned());
        self.floors().into_iter().map(name).collect()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        fs::remove_dir_all(self.0.path()).ok();
    }
}

fn map(width: usize) -> StoredMap {
    let floor = Raster::filled(Cell { x: 1, y: 2 }, width, 4, CellKnowledge::Free);
    StoredMap::from_raster(&floor, None)
}

fn called(name: &str) -> Option<RoomName> {
    Some(RoomName::new(name).expect("is a name"))
}

fn archived(name: &str, width: usize) -> ArchivedFloor {
    ArchivedFloor {
        name: called(name),
        map: vthal_core::stored_map::encode(&map(width)),
    }
}

#[test]
fn floors_are_kept_beside_those_that_there_are_and_no_name_is_there_twice() {
    let scratch = Scratch::home("beside");
    let before = scratch.floors();
    let taken = [archived("attic", 5), archived("attic", 6), archived("Cellar", 7)];
    assert_eq!(scratch.0.take_in(&taken).expect("takes"), [3, 4, 5]);
    let after = scratch.floors();
    assert_eq!(after[..2], before[..], "those that were there are untouched");
    let names = ["attic (2)", "attic (3)", "Cellar"].map(|name| Some(name.to_owned()));
    assert_eq!(scratch.names()[2..], names);
    let homes: Vec<_> = after[2..].iter().map(|floor| floor.home.clone()).collect();
    assert_eq!(homes, [5, 6, 7].map(|width| Some(map(width))));
}

#[test]
fn a_long_name_keeps_room_for_its_number() {
    let scratch = Scratch::new("long");
    let long = "Õ".repeat(40);
    for _ in 0..2 {
        scratch.0.take_in(&[archived(&long, 4)]).expect("takes");
    }
    let numbered = format!("{} (2)", "Õ".repeat(36));
    assert_eq!(scratch.names()[1..], [Some(long), Some(numbered)]);
}

#[test]
fn what_one_home_gives_another_one_takes() {
    let (giver, taker) = (Scratch::home("giver"), Scratch::new("taker"));
    giver.0.maps(1).save(&map(9)).expect("saves");
    giver.0.maps(2).save(&map(5)).expect("saves");
    assert_eq!(giver.0.archived(Some(2)), [archived("Attic", 5)]);
    taker.0.take_in(&giver.0.archived(None)).expect("takes");
    let homes: Vec<_> = taker.floors().into_iter().map(|floor| floor.home).collect();
    assert_eq!(homes, [None, Some(map(9)), Some(map(5))]);
    giver.0.change(&FloorTask::Remove(2)).expect("removes");
    assert_eq!(
        giver.0.archived(None).len(),
        1,
        "a removed floor is not taken along"
    );
    assert_eq!(giver.0.archived(Some(2)), []);
}

#[test]
fn more_floors_than_places_are_refused_and_a_removed_one_keeps_its_place() {
    let scratch = Scratch::home("places");
    for _ in 2..FLOORS_MAX {
        scratch.0.change(&FloorTask::New(None)).expect("makes");
    }
    scratch.0.change(&FloorTask::Remove(2)).expect("removes");
    let before = scratch.floors();
    let error = scratch.0.take_in(&[archived("Cellar", 5)]).expect_err("is full");
    assert_eq!(error.name(), "too-many-floors");
    assert!(error.to_string().contains("1 floors, and 0 of 16"), "{error}");
    assert_eq!(scratch.floors(), before);
}

#[test]
fn a_crash_before_the_list_leaves_everything_as_it_was() {
    let scratch = Scratch::home("before");
    let before = scratch.floors();
    let list = scratch.0.list().0;
    let floors = [archived("Cellar", 5), archived("Loft", 6)];
    let list = with_new(list, &floors).expect("has places");
    scratch.0.stage(&list.floors[2..], &floors).expect("writes");
    assert!(scratch.0.staged(3).exists());
    assert_eq!(scratch.floors(), before);
    assert!(!scratch.0.staged(3).exists() && !scratch.0.staged(4).exists());
}

#[test]
fn a_crash_after_the_list_is_finished_at_the_next_start() {
    let scratch = Scratch::home("after");
    let list = scratch.0.list().0;
    let floors = [archived("Cellar", 5), archived("Loft", 6)];
    let list = with_new(list, &floors).expect("has places");
    scratch.0.stage(&list.floors[2..], &floors).expect("writes");
    scratch.0.write(&list).expect("writes");
    // One folder has its name already.
    fs::rename(scratch.0.staged(3), scratch.0.maps(3).path()).expect("renames");
    let homes: Vec<_> = scratch.floors().into_iter().map(|floor| floor.home).collect();
    assert_eq!(homes, [Some(map(3)), None, Some(map(5)), Some(map(6))]);
    assert!(!scratch.0.staged(4).exists());
}
