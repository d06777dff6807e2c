//! Named zones and spots of clients, and orders that refer to them.

use brain::{Brain, EditError, KeptPlace, PlaceEdit, PlaceShape, Point2};
use rvac_api::{JobOrder, JobPart};

use crate::api_forms;
use crate::desk::words::{to_name, to_zone};
use crate::refusal::Refusal;

/// What is wrong with an edit of them, in words.
pub(super) fn refusal(error: EditError, edit: &PlaceEdit, brain: &Brain) -> Refusal {
    match (error, edit) {
        (EditError::NoFloorThere, _) => Refusal::no_floor_there("in it", brain),
        (EditError::NameTaken, _) => {
            Refusal::because(error, "Another place is called so: take another name.".to_owned())
        }
        (EditError::TooManyPlaces, _) => Refusal::because(
            error,
            "As many zones and spots are kept as a home can have: forget one first.".to_owned(),
        ),
        (EditError::NoSuchPlace, PlaceEdit::Keep { number, .. }) => Refusal::because(
            error,
            format!(
                "No place can come back under the number {}: leave it out.",
                number.unwrap_or_default()
            ),
        ),
        (
            EditError::NoSuchPlace,
            PlaceEdit::Name { number, .. } | PlaceEdit::Reshape { number, .. } | PlaceEdit::Forget { number },
        ) => no_such_place(*number, brain),
        _ => Refusal::from(error),
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
    Refusal::because(EditError::NoSuchPlace, text)
}

pub(crate) fn to_place(name: &str, shape: &rvac_api::PlaceShape) -> Result<KeptPlace, Refusal> {
    Ok(KeptPlace::new(to_name(name)?, &to_shape(shape)?)?)
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

/// The order with a spot for each place, for checks that need the number of parts only.
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
