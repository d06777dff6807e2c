//! Splitting and joining rooms, in maps that are drawn again and stored.

use std::collections::BTreeSet;

use proptest::prelude::*;

use crate::mapping::{CELL_M, Cell, CellKnowledge, Map, Raster, RoomChange, StoredMap};
use crate::model::cut_line::CutLine;
use crate::{Body, EditError, Point2, RoomName, SensorLayout};

const BODY: Body = Body {
    radius_m: 0.175,
    swath_m: 0.30,
    track_m: 0.23,
};

fn point(x_m: f64, y_m: f64) -> Point2 {
    Point2 { x_m, y_m }
}

fn line(from: Point2, to: Point2) -> CutLine {
    CutLine::new(from, to).expect("two places")
}

/// Two rooms side by side along x, 4 and 3 m long and 3 m deep, with a door of 0.8 m between them; all of it shifted by `shift_m`
/// to the right and up. `has_second` says whether the second room exists.
fn two_rooms(shift_m: f64, has_second: bool) -> StoredMap {
    let mut home = Raster::filled(Cell { x: -20, y: -20 }, 340, 170, CellKnowledge::Unknown);
    let rectangles = [
        ((-0.1, -0.1), (4.1, 3.1), CellKnowledge::Occupied),
        ((4.0, -0.1), (7.2, 3.1), CellKnowledge::Occupied),
        ((0.0, 0.0), (4.0, 3.0), CellKnowledge::Free),
        ((4.1, 0.0), (7.1, 3.0), CellKnowledge::Free),
        ((4.0, 1.0), (4.1, 1.8), CellKnowledge::Free),
    ];
    for index in 0..home.values().len() {
        let cell = home.cell(index);
        let at = [cell.x, cell.y].map(|cells| (f64::from(cells) + 0.5) * CELL_M - shift_m);
        for (low, high, kind) in rectangles {
            let is_inside = (low.0..high.0).contains(&at[0]) && (low.1..high.1).contains(&at[1]);
            if is_inside && (has_second || at[0] < 4.05) {
                home.values_mut()[index] = kind;
            }
        }
    }
    StoredMap::from_raster(&home, None)
}

fn map_of(stored: &StoredMap) -> Map {
    let mut map = Map::new(BODY, SensorLayout::default());
    map.load(stored);
    map
}

/// The home as mapped by the next run, with the known rooms and annotations.
fn mapped_again(map: &Map, shift_m: f64) -> Map {
    let mut again = map_of(&two_rooms(shift_m, true));
    again.home.rooms = map.home.rooms.clone();
    again.home.annotations = map.home.annotations.clone();
    again.segment_rooms();
    again
}

fn ids(map: &Map) -> Vec<u16> {
    map.rooms().rooms().iter().map(|room| room.id).collect()
}

fn area_m2(map: &Map, id: u16) -> f64 {
    let room = map.rooms().rooms().iter().find(|room| room.id == id);
    room.map_or(0.0, |room| room.area_m2)
}

#[test]
fn a_split_gives_the_larger_part_the_name_and_the_smaller_one_a_new_identity() {
    let mut map = map_of(&two_rooms(0.0, true));
    assert_eq!(ids(&map), [1, 2]);
    map.name_room(1, RoomName::new("Hall").ok()).unwrap();
    map.split_room(None, line(point(1.0, 0.2), point(1.0, 2.8)))
        .unwrap();
    assert_eq!(ids(&map), [1, 2, 3]);
    assert!((area_m2(&map, 1) - 9.0).abs() < 0.3 && (area_m2(&map, 3) - 3.0).abs() < 0.2);
    assert_eq!(map.rooms().room_at(point(0.5, 1.5)), Some(3));
    assert_eq!(map.annotations().name(1).map(RoomName::as_str), Some("Hall"));
    let beside: Vec<[u16; 2]> = map.rooms().doors().iter().map(|door| door.rooms).collect();
    assert_eq!(beside, [[1, 2], [1, 3]]);
}

#[test]
fn a_join_keeps_the_named_room_and_undoing_it_restores_the_other_one() {
    let mut map = map_of(&two_rooms(0.0, true));
    map.name_room(2, RoomName::new("Den").ok()).unwrap();
    map.join_rooms([1, 2]).unwrap();
    assert_eq!(ids(&map), [2]);
    assert!(area_m2(&map, 2) > 20.0);
    assert!(map.rooms().doors().is_empty());
    map.undo_room_change(1).unwrap();
    assert_eq!(ids(&map), [1, 2]);
    assert_eq!(map.annotations().name(2).map(RoomName::as_str), Some("Den"));
}

#[test]
fn a_name_that_a_join_hides_is_free_again() {
    let mut map = map_of(&two_rooms(0.0, true));
    let name = |text| RoomName::new(text).ok();
    map.name_room(1, name("Kitchen")).unwrap();
    map.name_room(2, name("Hall")).unwrap();
    assert_eq!(map.name_room(1, name("Hall")), Err(EditError::NameTaken));
    map.join_rooms([1, 2]).unwrap();
    map.name_room(1, name("Hall")).unwrap();
    map.undo_room_change(1).unwrap();
    assert_eq!(map.annotations().name(1).map(RoomName::as_str), Some("Hall"));
    assert_eq!(map.annotations().name(2), None, "two rooms never have one name");
}

#[test]
fn a_split_that_is_undone_and_repeated_gives_the_same_identity() {
    let mut map = map_of(&two_rooms(0.0, true));
    let cut = line(point(1.0, 0.0), point(1.0, 3.0));
    map.split_room(Some(1), cut).unwrap();
    map.name_room(3, RoomName::new("Niche").ok()).unwrap();
    map.undo_room_change(1).unwrap();
    assert_eq!(ids(&map), [1, 2]);
    map.split_room(Some(1), line(point(2.0, 0.0), point(2.0, 3.0)))
        .unwrap();
    assert_eq!(ids(&map), [1, 2, 4], "another split gives another one");
    map.undo_room_change(2).unwrap();
    let mut map = map_of(&map.stored());
    map.split_room(None, cut).unwrap();
    assert_eq!(ids(&map), [1, 2, 3]);
    assert_eq!(map.annotations().name(3).map(RoomName::as_str), Some("Niche"));
}

#[test]
fn invalid_changes_are_refused_by_name_and_change_nothing() {
    let mut map = map_of(&two_rooms(0.0, true));
    map.split_room(Some(1), line(point(1.0, 0.0), point(1.0, 3.0)))
        .unwrap();
    map.split_room(Some(1), line(point(2.5, 0.0), point(2.5, 3.0)))
        .unwrap();
    let (before, words) = (map.rooms().clone(), map.annotations().clone());
    let outside = line(point(9.0, 0.0), point(9.0, 3.0));
    for (done, reason) in [
        (map.split_room(None, outside), EditError::LineMissesRoom),
        (map.split_room(Some(9), outside), EditError::NoSuchRoom),
        (
            map.split_room(Some(2), line(point(5.0, 1.0), point(5.0, 1.5))),
            EditError::LineEndsInRoom,
        ),
        (
            map.split_room(Some(2), line(point(4.2, 0.0), point(4.2, 3.0))),
            EditError::PartTooSmall,
        ),
        (map.join_rooms([2, 3]), EditError::RoomsApart),
        (map.join_rooms([2, 2]), EditError::RoomsApart),
        (map.join_rooms([2, 9]), EditError::NoSuchRoom),
        (map.undo_room_change(7), EditError::NoSuchRoomChange),
        (map.undo_room_change(1), EditError::RoomChangeInUse),
    ] {
        assert_eq!(done, Err(reason));
    }
    assert_eq!((map.rooms(), map.annotations()), (&before, &words));
    let mut empty = Map::new(BODY, SensorLayout::default());
    assert_eq!(empty.split_room(None, outside), Err(EditError::NoMap));
}

#[test]
fn changes_survive_a_map_that_is_drawn_again_with_an_offset() {
    let mut map = map_of(&two_rooms(0.0, false));
    map.split_room(None, line(point(1.5, 0.1), point(1.5, 2.9)))
        .unwrap();
    map.name_room(2, RoomName::new("Niche").ok()).unwrap();
    assert_eq!(ids(&map), [1, 2]);
    let mut again = mapped_again(&map, 0.1);
    assert_eq!(ids(&again), [1, 2, 3], "with the room that was not known before");
    assert_eq!(again.rooms().room_at(point(0.8, 1.5)), Some(2));
    assert_eq!(again.rooms().room_at(point(6.0, 1.5)), Some(3));
    assert!((area_m2(&again, 2) - 4.5).abs() < 0.6, "{}", area_m2(&again, 2));
    again.join_rooms([1, 3]).unwrap();
    let third = mapped_again(&again, 0.0);
    assert_eq!(ids(&third), [2, 3], "the larger one goes on");
    assert!(area_m2(&third, 3) > 16.0);
    assert_eq!(third.annotations().name(2).map(RoomName::as_str), Some("Niche"));
}

#[test]
fn the_number_of_changes_is_limited_and_an_undo_makes_room() {
    let mut map = map_of(&two_rooms(0.0, true));
    for _ in 0..32 {
        map.split_room(Some(1), line(point(1.0, 0.0), point(1.0, 3.0)))
            .unwrap();
        let part = *ids(&map).last().unwrap();
        map.join_rooms([1, part]).unwrap();
    }
    assert_eq!(
        map.split_room(Some(1), line(point(1.0, 0.0), point(1.0, 3.0))),
        Err(EditError::TooManyRoomChanges)
    );
    let (last, _) = map.annotations().room_changes().made().last().unwrap();
    map.undo_room_change(last).unwrap();
    map.join_rooms([1, *ids(&map).last().unwrap()]).unwrap();
    assert_eq!(map_of(&map.stored()).rooms(), map.rooms());
}

#[derive(Clone, Debug)]
enum Wish {
    Split((f64, f64), (f64, f64)),
    Join(usize, usize),
    Undo,
    MapAgain(f64),
}

fn wish() -> impl Strategy<Value = Wish> {
    let place = || (-0.5..7.5_f64, -0.5..3.5_f64);
    prop_oneof![
        4 => (place(), place()).prop_map(|(from, to)| Wish::Split(from, to)),
        3 => (0..8_usize, 0..8_usize).prop_map(|(one, other)| Wish::Join(one, other)),
        2 => Just(Wish::Undo),
        1 => (-0.1..0.1_f64).prop_map(Wish::MapAgain),
    ]
}

/// Every cell in a segmented room is still in a room, and the list of rooms matches the labels.
fn check(map: &Map, floor_cells: usize) {
    let labels = map.rooms().labels().values();
    let in_rooms = labels.iter().filter(|label| **label != 0).count();
    assert_eq!(in_rooms, floor_cells);
    let there: BTreeSet<u16> = labels.iter().copied().filter(|label| *label != 0).collect();
    assert_eq!(there.into_iter().collect::<Vec<u16>>(), ids(map));
    let area: f64 = map.rooms().rooms().iter().map(|room| room.area_m2).sum();
    assert!((area - floor_cells as f64 * CELL_M * CELL_M).abs() < 1e-6);
}

fn floor_cells(map: &Map) -> usize {
    let found = map.rooms().found().values();
    found.iter().filter(|label| **label != 0).count()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn whatever_people_change_rooms_stay_apart_and_cover_the_floor(wishes in prop::collection::vec(wish(), 1..12)) {
        let mut map = map_of(&two_rooms(0.0, true));
        let mut undoable: Vec<(u16, Vec<u16>)> = Vec::new();
        for wish in wishes {
            let before = ids(&map);
            let done = match wish {
                Wish::Split(from, to) => CutLine::new(point(from.0, from.1), point(to.0, to.1))
                    .and_then(|line| map.split_room(None, line)),
                Wish::Join(one, other) => {
                    let pick = |place: usize| before[place % before.len()];
                    map.join_rooms([pick(one), pick(other)])
                }
                Wish::Undo => match undoable.pop() {
                    Some((number, rooms)) => {
                        map.undo_room_change(number).unwrap();
                        prop_assert_eq!(ids(&map), rooms, "as before change {}", number);
                        Ok(())
                    }
                    None => Err(EditError::NoSuchRoomChange),
                },
                Wish::MapAgain(shift_m) => {
                    map = mapped_again(&map, shift_m);
                    // After mapping anew there is nothing to return to.
                    undoable.clear();
                    Ok(())
                }
            };
            let made: Vec<u16> = map.annotations().room_changes().made().map(|(number, _)| number).collect();
            match (&wish, done) {
                (Wish::Split(..) | Wish::Join(..), Ok(())) => {
                    undoable.push((*made.last().unwrap(), before));
                }
                (_, Err(_)) => prop_assert_eq!(&ids(&map), &before),
                _ => {}
            }
            check(&map, floor_cells(&map));
            let stored = map.stored();
            prop_assert_eq!(&StoredMap::from_parts(stored.parts()).unwrap(), &stored);
            let back = map_of(&stored);
            prop_assert_eq!(back.rooms(), map.rooms());
            prop_assert_eq!(stored.room_count(), map.rooms().rooms().len());
        }
        for (_, change) in map.annotations().room_changes().made() {
            if let RoomChange::Split(split) = change {
                prop_assert_ne!(split.room, split.part);
            }
        }
    }
}
