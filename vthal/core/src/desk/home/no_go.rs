//! No-go zones and virtual walls of clients.

use brain::zone::COORDINATE_MAX_M;
use brain::{Brain, EditError, MapEdit, NoGo, NoGoEdit, Point2};
use rvac_api::NoGoShape;

use super::{AdmittedEdit, known_home};
use crate::brain_session::BrainSession;
use crate::desk::words::{to_name, to_zone};
use crate::refusal::Refusal;

/// Requests about no-go zones and virtual walls.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum NoGoRequest {
    /// Forbids floor.
    Add { shape: NoGoShape, name: Option<String> },
    /// Allows it again.
    Remove { number: u16 },
    /// Names it, or takes its name away.
    Name { number: u16, name: Option<String> },
    /// Forbids other floor under its number and name.
    Reshape { number: u16, shape: NoGoShape },
}

impl NoGoRequest {
    pub(super) fn edit(&self, brain_session: Option<&BrainSession>) -> Result<AdmittedEdit, Refusal> {
        match self {
            Self::Add { shape, name } => {
                let name = name.as_deref().map(to_name).transpose()?;
                let no_go = to_no_go(shape)?.with_name(name);
                let brain = known_home(brain_session)?.brain();
                let edit = MapEdit::NoGo(NoGoEdit::Add(no_go));
                AdmittedEdit::new(brain, edit, "forbids floor of the map")
                    .map_err(|error| of_forbidden(error, brain))
            }
            Self::Remove { number } => {
                let brain = known_home(brain_session)?.brain();
                let edit = MapEdit::NoGo(NoGoEdit::Remove { number: *number });
                AdmittedEdit::new(brain, edit, "allows floor of the map again")
                    .map_err(|error| Refusal::because(error, no_such_no_go(*number, brain)))
            }
            Self::Name { number, name } => {
                let name = name.as_deref().map(to_name).transpose()?;
                let brain = known_home(brain_session)?.brain();
                let edit = MapEdit::NoGo(NoGoEdit::Name {
                    number: *number,
                    name,
                });
                AdmittedEdit::new(brain, edit, "names forbidden floor").map_err(|error| match error {
                    EditError::NameTaken => another_no_go(),
                    _ => Refusal::because(error, no_such_no_go(*number, brain)),
                })
            }
            Self::Reshape { number, shape } => {
                let no_go = to_no_go(shape)?;
                let brain = known_home(brain_session)?.brain();
                let edit = MapEdit::NoGo(NoGoEdit::Reshape {
                    number: *number,
                    no_go,
                });
                AdmittedEdit::new(brain, edit, "reshapes forbidden floor").map_err(|error| match error {
                    EditError::NoSuchNoGo => Refusal::because(error, no_such_no_go(*number, brain)),
                    _ => of_forbidden(error, brain),
                })
            }
        }
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
