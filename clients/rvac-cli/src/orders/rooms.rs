//! `rvac rooms`: the rooms, their names, and how people split and joined them.

use std::io::{Write as _, stdout};
use std::process::ExitCode;

use anyhow::bail;
use rvac_api::{
    CleaningPattern, CleaningPower, HomeView, RequestBody, RoomNaming, RoomSettings, RoomSplitting, RoomView,
};

use crate::arguments::{RoomsJob, RoomsVerb};
use crate::control;
use crate::home::known;
use crate::socket::Connection;

pub(crate) fn rooms(job: &RoomsJob) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&job.daemon)?;
    let home = known::ask(&mut connection)?.home;
    let body = match &job.verb {
        None => {
            write!(stdout(), "{}", table(&home))?;
            return Ok(ExitCode::SUCCESS);
        }
        Some(RoomsVerb::Undo { number: None }) => {
            write!(stdout(), "{}", changes(&home))?;
            return Ok(ExitCode::SUCCESS);
        }
        Some(RoomsVerb::Name { room, name }) => RequestBody::NameRoom(RoomNaming {
            room: find(&home, room)?,
            name: Some(name.clone()),
        }),
        Some(RoomsVerb::Unname { room }) => RequestBody::NameRoom(RoomNaming {
            room: find(&home, room)?,
            name: None,
        }),
        Some(RoomsVerb::Unset { room }) => RequestBody::SetRoom {
            room: find(&home, room)?,
            settings: None,
            was: None,
        },
        Some(RoomsVerb::Set {
            room,
            passes,
            suction,
            main_brush,
            side_brushes,
            pattern,
        }) => {
            let room = find(&home, room)?;
            let known = home.rooms.iter().find(|known| known.id == room);
            let before = known.and_then(|known| known.settings).unwrap_or_default();
            let share = |percent: &Option<u8>, before: f64| {
                percent.map_or(before, |percent| f64::from(percent) / 100.0)
            };
            RequestBody::SetRoom {
                room,
                settings: Some(RoomSettings {
                    passes: passes.unwrap_or(before.passes),
                    power: CleaningPower {
                        suction: share(suction, before.power.suction),
                        main_brush: share(main_brush, before.power.main_brush),
                        side_brushes: share(side_brushes, before.power.side_brushes),
                    },
                    pattern: pattern.map_or(before.pattern, CleaningPattern::from),
                }),
                was: None,
            }
        }
        Some(RoomsVerb::Split { room, from, to }) => RequestBody::SplitRoom(RoomSplitting {
            room: Some(find(&home, room)?),
            line: [from, to].map(|end| [end.x_m, end.y_m]),
        }),
        Some(RoomsVerb::Join { room, other }) => RequestBody::JoinRooms {
            rooms: [find(&home, room)?, find(&home, other)?],
        },
        Some(RoomsVerb::Undo { number: Some(number) }) => RequestBody::UndoRoomChange { number: *number },
    };
    control::ask(&mut connection, body)
}

fn changes(home: &HomeView) -> String {
    if home.room_changes.is_empty() {
        return "the rooms are as the robot found them\n".to_owned();
    }
    let mut text = "number  change\n".to_owned();
    for change in &home.room_changes {
        let [room, other] = change.rooms;
        let what = match change.line {
            Some([[x, y], [to_x, to_y]]) => {
                format!("room {other} was split from room {room} at {x:.2},{y:.2} {to_x:.2},{to_y:.2}")
            }
            None => format!("room {other} is a part of room {room}"),
        };
        text += &format!("{:<7} {what}\n", change.number);
    }
    text
}

fn table(home: &HomeView) -> String {
    if home.rooms.is_empty() {
        return "no room is known yet: the robot finds them while it cleans\n".to_owned();
    }
    let mut text = "room  floor     name\n".to_owned();
    for room in &home.rooms {
        let name = room.name.as_deref().unwrap_or("-");
        let settings = room.settings.map(settings_text).unwrap_or_default();
        text += &format!("{:<5} {:>5.1} m2  {name}{settings}\n", room.id, room.area_m2);
    }
    text
}

/// `, 2 passes, suction 50 %, main brush 100 %, side brushes 0 %, contour`
fn settings_text(settings: RoomSettings) -> String {
    let CleaningPower {
        suction,
        main_brush,
        side_brushes,
    } = settings.power;
    format!(
        ", {} passes, suction {:.0} %, main brush {:.0} %, side brushes {:.0} %, {}",
        settings.passes,
        100.0 * suction,
        100.0 * main_brush,
        100.0 * side_brushes,
        settings.pattern.name()
    )
}

/// The identity of the room with this name or number.
pub(super) fn find(home: &HomeView, wanted: &str) -> anyhow::Result<u16> {
    let is_called = |room: &&RoomView| {
        let name = room.name.as_deref();
        name.is_some_and(|name| name.to_lowercase() == wanted.trim().to_lowercase())
    };
    let by_name = home.rooms.iter().find(is_called).map(|room| room.id);
    let by_number = || wanted.trim().parse().ok();
    let Some(id) = by_name.or_else(by_number) else {
        let names: Vec<String> = home.rooms.iter().map(called).collect();
        bail!(
            "no room is called {wanted:?}: the map has {}",
            if names.is_empty() {
                "no rooms yet".to_owned()
            } else {
                names.join(", ")
            }
        );
    };
    Ok(id)
}

fn called(room: &RoomView) -> String {
    match &room.name {
        Some(name) => format!("{} ({name})", room.id),
        None => room.id.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::{changes, find, table};
    use rvac_api::{HomeView, RoomChangeView, RoomSettings, RoomView};

    fn home() -> HomeView {
        let room = |id, name: Option<&str>| RoomView {
            id,
            area_m2: 12.25,
            x: 0.0,
            y: 0.0,
            name: name.map(str::to_owned),
            settings: None,
        };
        HomeView {
            rooms: vec![room(1, None), room(4, Some("Köök")), room(5, Some("1"))],
            ..HomeView::default()
        }
    }

    #[test]
    fn a_room_is_found_by_its_name_first_and_else_by_its_number() {
        for (wanted, id) in [("köök", 4), (" 4", 4), ("1", 5), ("77", 77)] {
            assert_eq!(find(&home(), wanted).expect("is found"), id, "{wanted}");
        }
        let error = find(&home(), "Attic").expect_err("is unknown").to_string();
        assert!(error.contains("1, 4 (Köök), 5 (1)"), "{error}");
    }

    #[test]
    fn each_change_has_a_line() {
        let change = |number, line| RoomChangeView {
            number,
            rooms: [1, 5],
            line,
        };
        let home = HomeView {
            room_changes: vec![change(2, Some([[0.0, 0.5], [-1.0, 0.5]])), change(3, None)],
            ..HomeView::default()
        };
        let text = changes(&home);
        assert!(
            text.contains("2       room 5 was split from room 1 at 0.00,0.50 -1.00,0.50\n"),
            "{text}"
        );
        assert!(text.ends_with("3       room 5 is a part of room 1\n"), "{text}");
        assert!(changes(&HomeView::default()).contains("as the robot found them"));
    }

    #[test]
    fn the_table_has_a_line_for_each_room() {
        assert!(
            table(&home()).ends_with("4      12.2 m2  Köök\n5      12.2 m2  1\n"),
            "{}",
            table(&home())
        );
        assert!(table(&HomeView::default()).starts_with("no room"));
        let mut home = home();
        home.rooms[0].settings = Some(RoomSettings {
            passes: 2,
            ..RoomSettings::default()
        });
        assert!(
            table(&home)
                .contains("m2  -, 2 passes, suction 100 %, main brush 100 %, side brushes 100 %, lines"),
            "{}",
            table(&home)
        );
    }
}
