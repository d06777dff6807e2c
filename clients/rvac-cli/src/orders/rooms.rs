//! `rvac rooms`: the rooms and their names.

use std::io::{Write as _, stdout};
use std::process::ExitCode;

use anyhow::bail;
use rvac_api::{HomeView, RequestBody, RoomNaming, RoomView};

use crate::arguments::{RoomsJob, RoomsVerb};
use crate::control;
use crate::home::known;
use crate::socket::Connection;

pub(crate) fn rooms(job: &RoomsJob) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&job.daemon.socket)?;
    let home = known::ask(&mut connection)?.home;
    let naming = match &job.verb {
        None => {
            write!(stdout(), "{}", table(&home))?;
            return Ok(ExitCode::SUCCESS);
        }
        Some(RoomsVerb::Name { room, name }) => RoomNaming {
            room: find(&home, room)?,
            name: Some(name.clone()),
        },
        Some(RoomsVerb::Unname { room }) => RoomNaming {
            room: find(&home, room)?,
            name: None,
        },
    };
    control::ask(&mut connection, RequestBody::NameRoom(naming))
}

fn table(home: &HomeView) -> String {
    if home.rooms.is_empty() {
        return "no room is known yet: the robot finds them while it cleans\n".to_owned();
    }
    let mut text = "room  floor     name\n".to_owned();
    for room in &home.rooms {
        let name = room.name.as_deref().unwrap_or("-");
        text += &format!("{:<5} {:>5.1} m2  {name}\n", room.id, room.area_m2);
    }
    text
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
    use super::{find, table};
    use rvac_api::{HomeView, RoomView};

    fn home() -> HomeView {
        let room = |id, name: Option<&str>| RoomView {
            id,
            area_m2: 12.25,
            x: 0.0,
            y: 0.0,
            name: name.map(str::to_owned),
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
    fn the_table_has_a_line_for_each_room() {
        assert!(
            table(&home()).ends_with("4      12.2 m2  Köök\n5      12.2 m2  1\n"),
            "{}",
            table(&home())
        );
        assert!(table(&HomeView::default()).starts_with("no room"));
    }
}
