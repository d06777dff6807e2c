//! `rvac map`: the robot's map of the home, its stored versions, and the return to one of them.

pub(crate) mod known;
mod picture;

use std::io::{Write as _, stdout};
use std::process::ExitCode;
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::bail;
use rvac_api::{Estimate, HomeView, KeptMap, Pose, RequestBody, RoomView, Update, explain};

use crate::arguments::{Daemon, MapJob, MapVerb, Place};
use crate::control;
use crate::floors;
use crate::socket::Connection;
use known::KnownHome;
use picture::picture;

/// Least distance of the place that the robot faces, metres.
const LOOK_MIN_M: f64 = 0.01;

pub(crate) fn run(job: &MapJob) -> anyhow::Result<ExitCode> {
    match &job.verb {
        None => show(job),
        Some(MapVerb::List { floor }) => list(&job.daemon, floor.as_deref()),
        Some(MapVerb::Restore { number, floor }) => {
            let mut connection = Connection::open(&job.daemon)?;
            let request = RequestBody::RestoreMap {
                number: *number,
                floor: floor_meant(&mut connection, floor.as_deref())?,
            };
            control::ask(&mut connection, request)
        }
        Some(MapVerb::Dock { at, towards }) => {
            let mut connection = Connection::open(&job.daemon)?;
            control::ask(&mut connection, dock_moved(*at, *towards)?)
        }
    }
}

/// The dock of a robot that is at a place and faces another one.
fn dock_moved(at: Place, towards: Place) -> anyhow::Result<RequestBody> {
    let (x_m, y_m) = (towards.x_m - at.x_m, towards.y_m - at.y_m);
    if x_m.hypot(y_m) < LOOK_MIN_M {
        bail!(
            "both places are the same: the second one says where the robot looks, for example the wall behind the dock"
        );
    }
    Ok(RequestBody::MoveDock {
        x: at.x_m,
        y: at.y_m,
        heading: y_m.atan2(x_m),
    })
}

fn floor_meant(connection: &mut Connection, wanted: Option<&str>) -> anyhow::Result<Option<u16>> {
    let Some(wanted) = wanted else {
        return Ok(None);
    };
    let (floors, _) = floors::ask(connection)?;
    floors::find(&floors, wanted).map(Some)
}

fn show(job: &MapJob) -> anyhow::Result<ExitCode> {
    let KnownHome {
        home,
        text,
        estimate,
        pose,
    } = known::ask(&mut Connection::open(&job.daemon)?)?;
    if job.json {
        writeln!(stdout(), "{text}")?;
        return Ok(ExitCode::SUCCESS);
    }
    write!(stdout(), "{}", in_words(&home, estimate, pose))?;
    if estimate.is_some_and(|estimate| estimate.map_doubt.is_some()) {
        let maps = kept_maps(&mut Connection::open(&job.daemon)?, None)?;
        write!(stdout(), "{}", way_back(&maps))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// How to come back to the map as it was before it was spoilt; empty when no such version is known.
fn way_back(maps: &[KeptMap]) -> String {
    let good = maps.iter().find(|map| map.last_good);
    good.map_or_else(String::new, |map| {
        let number = map.number;
        format!("last good map backup: {number}; rvac map restore {number} takes it up\n")
    })
}

fn in_words(home: &HomeView, estimate: Option<Estimate>, pose: Option<Pose>) -> String {
    let free: u64 = home
        .cells
        .chunks_exact(2)
        .filter(|run| run.first() == Some(&1))
        .map(|run| run.last().copied().map_or(0, u64::from))
        .sum();
    let mut text = format!(
        "home      {:.1} m2 of free floor, {}, {}, {}\n",
        free as f64 * home.cell_m * home.cell_m,
        counted(home.rooms.len(), "room"),
        counted(home.doors.len(), "door"),
        counted(home.walls.len(), "wall"),
    );
    text += &match &home.carpet {
        Some(carpet) => format!(
            "carpet    {:.1} m2, and {:.1} m2 of hard floor; the rest was not felt\n",
            carpet.area_m2, carpet.hard_m2
        ),
        None => "carpet    not known: the robot does not measure what its motors draw\n".to_owned(),
    };
    text += &match &home.dock {
        Some(dock) => {
            let told = if home.dock_reported {
                ", as somebody has said: the robot has not docked there yet"
            } else {
                ""
            };
            format!("dock      x {:.2} m, y {:.2} m{told}\n", dock.x, dock.y)
        }
        None => "dock      not known\n".to_owned(),
    };
    if let Some(pose) = pose {
        text += &format!(
            "pose      x {:.2} m, y {:.2} m, heading {:.0} deg",
            pose.x,
            pose.y,
            pose.heading.to_degrees()
        );
        text += &estimate.map_or_else(String::new, |estimate| format!(", {}", sureness(&estimate)));
        text += "\n";
    }
    if let Some(sure) = sure_of(home, None) {
        text += &format!("map       {sure}\n");
    }
    for room in &home.rooms {
        text += &format!(
            "room {:<4} {:.1} m2{}{}{}\n",
            room.id,
            room.area_m2,
            named(room),
            doors_of(home, room.id),
            sure_of(home, Some(room.id)).map_or_else(String::new, |sure| format!("; {sure}"))
        );
    }
    text + &picture(home, pose)
}

/// How sure the map of a room is, or of the whole home, in words.
fn sure_of(home: &HomeView, room: Option<u16>) -> Option<String> {
    let sure = home.sureness.iter().find(|sure| sure.room == room)?;
    Some(format!(
        "sure to {:.2} m, driven over {:.0} % of its floor, only touched {:.0} % of what borders it",
        sure.sigma_m,
        100.0 * sure.driven,
        100.0 * sure.touched
    ))
}

fn named(room: &RoomView) -> String {
    room.name
        .as_ref()
        .map_or_else(String::new, |name| format!(", {name}"))
}

/// How sure the robot is of its place, in words.
pub(crate) fn sureness(estimate: &Estimate) -> String {
    let mut text = if estimate.lost {
        "lost: it does not know where it is".to_owned()
    } else {
        format!(
            "position known to {:.2} m, heading to {:.0} deg",
            estimate.sigma_m,
            estimate.sigma_rad.to_degrees()
        )
    };
    if let Some(agreement) = estimate.agreement {
        text += &format!(", sensors match the map: {:.0} %", 100.0 * agreement);
    }
    if let Some(covered) = estimate.covered {
        text += &format!(", estimated coverage {:.0} % of the known floor", 100.0 * covered);
        if let Some(low) = estimate.covered_low {
            text += &format!(" (at least {:.0} %)", 100.0 * low);
        }
    }
    if let Some(told) = estimate.map_doubt.and_then(|doubt| explain(doubt.code())) {
        text += &format!("\nthe map is doubted: {}", told.text());
    }
    text
}

fn counted(number: usize, what: &str) -> String {
    match number {
        1 => format!("1 {what}"),
        _ => format!("{number} {what}s"),
    }
}

fn doors_of(home: &HomeView, room: u16) -> String {
    let mut others: Vec<u16> = home
        .doors
        .iter()
        .filter_map(|door| match door.rooms {
            [one, other] if one == room => Some(other),
            [one, other] if other == room => Some(one),
            _ => None,
        })
        .collect();
    others.sort_unstable();
    others.dedup();
    let names: Vec<String> = others.iter().map(u16::to_string).collect();
    match names.len() {
        0 => String::new(),
        1 => format!(", door to room {}", names.join(", ")),
        _ => format!(", doors to rooms {}", names.join(", ")),
    }
}

fn list(daemon: &Daemon, floor: Option<&str>) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(daemon)?;
    let floor = floor_meant(&mut connection, floor)?;
    let maps = kept_maps(&mut connection, floor)?;
    write!(stdout(), "{}", table(&maps, now_s()))?;
    Ok(ExitCode::SUCCESS)
}

/// The versions of the map of a floor, else of that on which the robot is, newest first.
fn kept_maps(connection: &mut Connection, floor: Option<u16>) -> anyhow::Result<Vec<KeptMap>> {
    let request = RequestBody::Maps { floor };
    control::answer(connection, request, control::ANSWER, |update, _| match update {
        Update::Maps { maps, .. } => Some(maps),
        _ => None,
    })
}

fn now_s() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |since| since.as_secs())
}

fn table(maps: &[KeptMap], now_s: u64) -> String {
    if maps.is_empty() {
        return "no map backups yet: one is made when a run ends\n".to_owned();
    }
    let mut text = "number  kept             floor     rooms\n".to_owned();
    for (place, map) in maps.iter().enumerate() {
        let marks = [
            (place == 0, "  newest"),
            (map.doubted, "  doubted"),
            (map.last_good, "  last good"),
        ];
        let marks: String = marks.iter().filter(|mark| mark.0).map(|mark| mark.1).collect();
        text += &format!(
            "{:<7} {:<16} {:>6.1} m2 {:>5}{marks}\n",
            map.number,
            age(now_s.saturating_sub(map.kept_s)),
            map.area_m2,
            map.rooms
        );
    }
    text + "rvac map restore NUMBER takes a version up again\n"
}

fn age(seconds: u64) -> String {
    match seconds {
        0..60 => "just now".to_owned(),
        60..3_600 => format!("{} min ago", seconds / 60),
        3_600..172_800 => format!("{} h ago", seconds / 3_600),
        _ => format!("{} days ago", seconds / 86_400),
    }
}

#[cfg(test)]
mod tests {
    use super::{age, doors_of, sure_of, way_back};
    use rvac_api::{DoorView, HomeView, KeptMap, SurenessView};

    #[test]
    fn the_way_back_names_the_last_good_version() {
        let kept = |number: u64, last_good: bool| KeptMap {
            number,
            kept_s: 0,
            area_m2: 20.0,
            rooms: 2,
            doubted: !last_good,
            last_good,
        };
        assert_eq!(
            way_back(&[kept(7, false), kept(6, true)]),
            "last good map backup: 6; rvac map restore 6 takes it up\n"
        );
        assert_eq!(way_back(&[kept(7, false)]), "");
    }

    #[test]
    fn ages_are_shown_roughly() {
        for (seconds, words) in [
            (5, "just now"),
            (3_599, "59 min ago"),
            (7_200, "2 h ago"),
            (400_000, "4 days ago"),
        ] {
            assert_eq!(age(seconds), words);
        }
    }

    #[test]
    fn a_room_names_its_neighbours_once() {
        let door = |rooms| DoorView {
            rooms,
            x: 0.0,
            y: 0.0,
            width_m: 0.8,
        };
        let home = HomeView {
            doors: vec![door([1, 3]), door([2, 1]), door([1, 2])],
            ..HomeView::default()
        };
        assert_eq!(doors_of(&home, 1), ", doors to rooms 2, 3");
        assert_eq!(doors_of(&home, 3), ", door to room 1");
        assert_eq!(doors_of(&home, 9), "");
    }

    #[test]
    fn a_map_says_how_sure_it_is_where_that_is_shown() {
        let home = HomeView {
            sureness: vec![
                SurenessView::default(),
                SurenessView {
                    room: Some(3),
                    sigma_m: 0.041,
                    driven: 0.92,
                    touched: 0.25,
                },
            ],
            ..HomeView::default()
        };
        assert_eq!(
            sure_of(&home, Some(3)).as_deref(),
            Some("sure to 0.04 m, driven over 92 % of its floor, only touched 25 % of what borders it")
        );
        assert!(sure_of(&home, None).is_some_and(|text| text.starts_with("sure to 0.00 m")));
        assert_eq!(sure_of(&home, Some(4)), None);
    }
}
