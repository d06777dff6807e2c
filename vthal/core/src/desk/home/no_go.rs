//! No-go zones and virtual walls of clients: their forms, and what is wrong with an edit of them.

use brain::zone::COORDINATE_MAX_M;
use brain::{Brain, EditError, NoGo, NoGoEdit, Point2};
use rvac_api::{NoGoShape, short_number};

use crate::desk::words::to_zone;
use crate::refusal::Refusal;

/// What is wrong with an edit of them, in words.
pub(super) fn refusal(error: EditError, edit: &NoGoEdit, brain: &Brain) -> Refusal {
    match (error, edit) {
        (EditError::NameTaken, NoGoEdit::Name { .. }) => another_no_go(),
        (_, NoGoEdit::Name { number, .. } | NoGoEdit::Remove { number })
        | (EditError::NoSuchNoGo, NoGoEdit::Reshape { number, .. }) => {
            Refusal::because(error, no_such_no_go(*number, brain))
        }
        (_, NoGoEdit::Add(_) | NoGoEdit::Reshape { .. }) => of_forbidden(error, brain),
    }
}

pub(crate) fn to_no_go(shape: &NoGoShape) -> Result<NoGo, Refusal> {
    match shape {
        NoGoShape::Zone(corners) => Ok(NoGo::zone(&to_zone("The no-go zone", corners)?)?),
        NoGoShape::Wall([[x, y], [to_x, to_y]]) => {
            let (from, to) = (
                Point2 { x_m: *x, y_m: *y },
                Point2 {
                    x_m: *to_x,
                    y_m: *to_y,
                },
            );
            NoGo::wall(from, to).map_err(|error| {
                let [x, y, to_x, to_y] = [*x, *y, *to_x, *to_y].map(short_number);
                let text = format!(
                    "The virtual wall from x {x} m, y {y} m to x {to_x} m, y {to_y} m cannot be: its ends must be two \
                     places within {COORDINATE_MAX_M} m."
                );
                Refusal::because(error, text)
            })
        }
    }
}

/// Why floor is not forbidden.
fn of_forbidden(error: EditError, brain: &Brain) -> Refusal {
    match error {
        EditError::NoFloorThere => Refusal::no_floor_there("in it", brain),
        EditError::DockInside => Refusal::because(error, dock_inside(brain)),
        EditError::NameTaken => another_no_go(),
        _ => Refusal::from(error),
    }
}

fn dock_inside(brain: &Brain) -> String {
    let place = brain.map().dock().unwrap_or_default();
    format!(
        "The dock stands there (x {:.2} m, y {:.2} m), and the robot could not reach it any more: leave room around it.",
        place.x_m, place.y_m
    )
}

fn another_no_go() -> Refusal {
    let text = "Another no-go zone or virtual wall is called so: take another name.";
    Refusal::because(EditError::NameTaken, text.to_owned())
}

fn no_such_no_go(number: u16, brain: &Brain) -> String {
    let numbers: Vec<String> = brain
        .map()
        .annotations()
        .no_go()
        .map(|(number, _)| number.to_string())
        .collect();
    if numbers.is_empty() {
        return format!("There is no no-go zone {number}: the map has none.");
    }
    format!(
        "There is no no-go zone {number}: the map has {}.",
        numbers.join(", ")
    )
}
