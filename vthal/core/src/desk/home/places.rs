//! Zones and spots that clients keep under names, and jobs that name them.

use brain::{Brain, Command, KeptPlace, PlaceShape, Point2, Reason};
use rvac_api::{JobOrder, JobPart};

use super::{Edit, known_home};
use crate::api_forms;
use crate::brain_session::BrainSession;
use crate::desk::words::{to_name, to_zone};
use crate::refusal::Refusal;

/// What clients say of places.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PlaceRequest {
    /// Keeps one, under a number that it had before if one is given.
    Keep {
        name: String,
        shape: rvac_api::PlaceShape,
        number: Option<u16>,
    },
    /// Names it otherwise.
    Name { number: u16, name: String },
    /// It is elsewhere.
    Reshape {
        number: u16,
        shape: rvac_api::PlaceShape,
    },
    /// Keeps it no longer.
    Forget { number: u16 },
}

impl PlaceRequest {
    pub(super) fn edit(&self, mind: Option<&BrainSession>) -> Result<Edit, Refusal> {
        let (command, deed) = match self {
            Self::Keep { name, shape, number } => {
                let place = KeptPlace::new(to_name(name)?, &to_shape(shape)?)?;
                let number = *number;
                (Command::KeepPlace { place, number }, "keeps a place")
            }
            Self::Name { number, name } => {
                let (number, name) = (*number, to_name(name)?);
                (Command::NamePlace { number, name }, "names a place")
            }
            Self::Reshape { number, shape } => {
                let (number, shape) = (*number, to_shape(shape)?);
                (Command::ReshapePlace { number, shape }, "moves a place")
            }
            Self::Forget { number } => {
                let number = *number;
                (Command::ForgetPlace { number }, "keeps a place no longer")
            }
        };
        let brain = known_home(mind)?.brain();
        brain
            .admit(&command)
            .map_err(|reason| of_place(reason, &command, brain))?;
        Ok(Edit { command, deed })
    }
}

/// Why a place is not changed.
fn of_place(reason: Reason, command: &Command, brain: &Brain) -> Refusal {
    match (reason, command) {
        (Reason::NoFloorThere, _) => Refusal::no_floor_there("in it", brain),
        (Reason::NameTaken, _) => Refusal::because(
            reason,
            "Another place is called so: take another name.".to_owned(),
        ),
        (Reason::TooManyPlaces, _) => Refusal::because(
            reason,
            "As many zones and spots are kept as a home can have: forget one first.".to_owned(),
        ),
        (Reason::NoSuchPlace, Command::KeepPlace { number, .. }) => Refusal::because(
            reason,
            format!(
                "No place can come back under the number {}: leave it out.",
                number.unwrap_or_default()
            ),
        ),
        (
            Reason::NoSuchPlace,
            Command::NamePlace { number, .. }
            | Command::ReshapePlace { number, .. }
            | Command::ForgetPlace { number },
        ) => no_such_place(*number, brain),
        _ => Refusal::from(reason),
    }
}

fn no_such_place(number: u16, brain: &Brain) -> Refusal {
    let places = brain.map().annotations().places();
    let known: Vec<String> = places
        .map(|(number, place)| format!("{number} ({})", place.name().as_str()))
        .collect();
    let text = if known.is_empty() {
        format!("There is no kept place {number}: the map has none.")
    } else {
        format!(
            "There is no kept place {number}: the map has {}.",
            known.join(", ")
        )
    };
    Refusal::because(Reason::NoSuchPlace, text)
}

pub(crate) fn to_shape(shape: &rvac_api::PlaceShape) -> Result<PlaceShape, Refusal> {
    match shape {
        rvac_api::PlaceShape::Zone(corners) => to_zone("The place", corners).map(PlaceShape::Zone),
        rvac_api::PlaceShape::Spot([x_m, y_m]) => Ok(PlaceShape::Spot(Point2 { x_m: *x_m, y_m: *y_m })),
    }
}

/// The order with the zones and spots that its places are now.
pub(crate) fn with_places(order: &JobOrder, brain: &Brain) -> Result<JobOrder, Refusal> {
    let words = brain.map().annotations();
    let part = |part: &JobPart| match part {
        JobPart::Place(number) => match words.place(*number) {
            Some(place) => Ok(match api_forms::place(place.shape()) {
                rvac_api::PlaceShape::Zone(corners) => JobPart::Zone(corners),
                rvac_api::PlaceShape::Spot(middle) => JobPart::Spot(middle),
            }),
            None => Err(no_such_place(*number, brain)),
        },
        other => Ok(other.clone()),
    };
    let parts: Result<Vec<JobPart>, Refusal> = order.parts.iter().map(part).collect();
    Ok(JobOrder {
        parts: parts?,
        ..order.clone()
    })
}

/// The order as one that is looked at before anybody knows its places: each counts as a part.
pub(crate) fn with_any_places(order: &JobOrder) -> JobOrder {
    let part = |part: &JobPart| match part {
        JobPart::Place(_) => JobPart::Spot([0.0, 0.0]),
        other => other.clone(),
    };
    JobOrder {
        parts: order.parts.iter().map(part).collect(),
        ..order.clone()
    }
}
