//! How people have changed the rooms: as rows, and which rooms can be made one.

use rvac_api::{HomeView, RoomChangeView};

use crate::home::room_name;
use crate::words::Words;

/// A change of the rooms as a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoomChangeRow {
    /// Its number.
    pub number: u16,
    /// `Room 5 was split from Kitchen`
    pub text: String,
    /// No later change builds on it.
    pub can_be_taken_back: bool,
}

/// The changes in the order in which they were made.
#[must_use]
pub fn room_change_rows(words: &Words, home: &HomeView) -> Vec<RoomChangeRow> {
    let changes = &home.room_changes;
    let row = |(place, change): (usize, &RoomChangeView)| {
        let [room, other] = change.rooms.map(|id| name_of(words, home, id));
        let text = match change.line {
            Some(_) => words.home.was_split.fill([&room, &other]),
            None => words.home.was_joined.fill([&room, &other]),
        };
        let later = changes.iter().skip(place + 1);
        let mut rooms = later.flat_map(|later| later.rooms);
        RoomChangeRow {
            number: change.number,
            text,
            can_be_taken_back: !rooms.any(|id| change.rooms.contains(&id)),
        }
    };
    changes.iter().enumerate().map(row).collect()
}

/// A room may be hidden by a later change, and is known by its number then.
fn name_of(words: &Words, home: &HomeView, id: u16) -> String {
    let known = home.rooms.iter().find(|room| room.id == id);
    known.map_or_else(|| words.home.room.fill([&id]), |room| room_name(words, room))
}

/// Whether these are two rooms that lie beside each other.
#[must_use]
pub fn joinable(home: &HomeView, rooms: &[u16]) -> Option<[u16; 2]> {
    let &[one, other] = rooms else { return None };
    let pair = [one, other];
    let is_between = |between: &rvac_api::DoorView| between.rooms.iter().all(|id| pair.contains(id));
    (one != other && home.doors.iter().any(is_between)).then_some(pair)
}

#[cfg(test)]
mod tests {
    use super::{joinable, room_change_rows};
    use crate::words::Language;
    use rvac_api::{DoorView, HomeView, RoomChangeView, RoomView};

    fn home() -> HomeView {
        let change = |number, rooms, is_split: bool| RoomChangeView {
            number,
            rooms,
            line: is_split.then_some([[0.0, 0.0], [1.0, 0.0]]),
        };
        let room = |id, name: Option<&str>| RoomView {
            id,
            area_m2: 4.0,
            x: 0.0,
            y: 0.0,
            name: name.map(str::to_owned),
            settings: None,
        };
        HomeView {
            rooms: vec![room(1, Some("Hall")), room(2, None), room(6, None)],
            doors: vec![DoorView {
                rooms: [1, 6],
                x: 0.0,
                y: 0.0,
                width_m: 0.8,
            }],
            room_changes: vec![
                change(1, [1, 5], true),
                change(2, [1, 6], true),
                change(4, [2, 3], false),
            ],
            ..HomeView::default()
        }
    }

    #[test]
    fn each_change_is_shown_and_the_one_on_which_none_builds_can_be_taken_back() {
        let rows = room_change_rows(Language::English.words(), &home());
        let told: Vec<(u16, &str, bool)> = rows
            .iter()
            .map(|row| (row.number, row.text.as_str(), row.can_be_taken_back))
            .collect();
        assert_eq!(
            told,
            [
                (1, "Room\u{a0}5 was split from Hall", false),
                (2, "Room\u{a0}6 was split from Hall", true),
                (4, "Room\u{a0}3 is a part of Room\u{a0}2", true),
            ]
        );
    }

    #[test]
    fn two_rooms_beside_each_other_can_be_one() {
        assert_eq!(joinable(&home(), &[6, 1]), Some([6, 1]));
        for rooms in [&[1, 2][..], &[1], &[1, 1], &[1, 6, 2], &[]] {
            assert_eq!(joinable(&home(), rooms), None, "{rooms:?}");
        }
    }
}
