//! `rvac floor`: the floors of the home, and on which of them the robot is.

mod archive;

use std::io::{Write as _, stdout};
use std::process::ExitCode;

use anyhow::bail;
use rvac_api::{FloorView, FloorsView, RequestBody, Topic, Update};

use crate::arguments::{FloorJob, FloorVerb};
use crate::control;
use crate::socket::Connection;

pub(crate) fn run(job: &FloorJob) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&job.daemon)?;
    let (floors, text) = ask(&mut connection)?;
    let Some(verb) = &job.verb else {
        if job.json {
            writeln!(stdout(), "{text}")?;
        } else {
            write!(stdout(), "{}", in_words(&floors))?;
        }
        return Ok(ExitCode::SUCCESS);
    };
    let body = match verb {
        FloorVerb::Export { file, floor } => {
            let floor = floor.as_ref().map(|wanted| find(&floors, wanted)).transpose()?;
            return archive::export(&mut connection, floor, file);
        }
        FloorVerb::Import { file } => return archive::import(&mut connection, &floors, file),
        FloorVerb::Choose { floor } => RequestBody::ChooseFloor {
            floor: find(&floors, floor)?,
        },
        FloorVerb::New { name } => RequestBody::NewFloor { name: name.clone() },
        FloorVerb::Name { floor, name } => RequestBody::NameFloor {
            floor: find(&floors, floor)?,
            name: Some(name.clone()),
        },
        FloorVerb::Unname { floor } => RequestBody::NameFloor {
            floor: find(&floors, floor)?,
            name: None,
        },
        FloorVerb::Remove { floor } => RequestBody::RemoveFloor {
            floor: find(&floors, floor)?,
        },
        FloorVerb::Restore { floor } => RequestBody::RestoreFloor {
            floor: find(&floors, floor)?,
        },
    };
    control::ask(&mut connection, body)
}

/// The floors as the daemon reports them, and its own text.
pub(crate) fn ask(connection: &mut Connection) -> anyhow::Result<(FloorsView, String)> {
    control::followed(connection, vec![Topic::Floors], |update, text| match update {
        Update::Floors(floors) => Some((floors, text)),
        _ => None,
    })
}

/// Number of the floor with this name or number.
pub(crate) fn find(floors: &FloorsView, wanted: &str) -> anyhow::Result<u16> {
    let wanted = wanted.trim();
    let is_called = |floor: &&FloorView| {
        let name = floor.name.as_deref();
        name.is_some_and(|name| name.to_lowercase() == wanted.to_lowercase())
    };
    // Of two with one name the one that is there is meant; a removed one has a number besides.
    let named = floors.floors.iter().filter(is_called);
    let by_name = named.min_by_key(|floor| floor.removed).map(|floor| floor.number);
    let Some(number) = by_name.or_else(|| wanted.parse().ok()) else {
        let titles: Vec<String> = floors.floors.iter().map(called).collect();
        bail!("no floor is called {wanted:?}: there are {}", titles.join(", "));
    };
    Ok(number)
}

fn called(floor: &FloorView) -> String {
    match &floor.name {
        Some(name) => format!("{} ({name})", floor.number),
        None => floor.number.to_string(),
    }
}

fn in_words(floors: &FloorsView) -> String {
    let mut text = "number  size        rooms  name\n".to_owned();
    for floor in &floors.floors {
        let here = if floors.here == Some(floor.number) {
            "  the robot is here"
        } else if floor.removed {
            "  removed"
        } else {
            ""
        };
        text += &format!(
            "{:<7} {:>6.1} m2   {:>5}  {}{here}\n",
            floor.number,
            floor.area_m2,
            floor.rooms,
            floor.name.as_deref().unwrap_or("-"),
        );
    }
    match (&floors.question, floors.here) {
        (Some(question), _) => text += &format!("{}\n", question.text),
        (None, None) => {
            text += "the robot does not know yet on which floor it is: it finds out on a dock, or while it drives\n";
        }
        (None, Some(_)) => {}
    }
    text
}

#[cfg(test)]
mod tests {
    use rvac_api::{FloorQuestion, FloorView, FloorsView};

    use super::{find, in_words};

    fn floors() -> FloorsView {
        let floor = |number, name: Option<&str>, removed| FloorView {
            number,
            name: name.map(str::to_owned),
            area_m2: 41.26,
            rooms: 3,
            has_dock: true,
            removed,
        };
        FloorsView {
            floors: vec![
                floor(1, None, false),
                floor(2, Some("Attic"), true),
                floor(4, Some("Attic"), false),
            ],
            here: Some(4),
            ..FloorsView::default()
        }
    }

    #[test]
    fn a_floor_is_found_by_its_name_or_number() {
        for (wanted, number) in [("attic", 4), (" 2", 2), ("1", 1)] {
            assert_eq!(find(&floors(), wanted).expect("is found"), number, "{wanted}");
        }
        let error = find(&floors(), "Cellar").expect_err("is unknown").to_string();
        assert!(error.contains("1, 2 (Attic), 4 (Attic)"), "{error}");
    }

    #[test]
    fn the_list_says_where_the_robot_is_or_what_it_asks() {
        let words = in_words(&floors());
        assert!(
            words.contains("4         41.3 m2       3  Attic  the robot is here\n"),
            "{words}"
        );
        assert!(words.contains("Attic  removed\n"), "{words}");
        let asked = FloorsView {
            here: None,
            question: Some(FloorQuestion {
                reason: "which-dock".to_owned(),
                text: "Which?".to_owned(),
            }),
            ..floors()
        };
        assert!(in_words(&asked).ends_with("Which?\n"));
    }
}
