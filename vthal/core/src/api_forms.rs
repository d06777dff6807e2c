//! What people order and draw, between the brain's types and those of the interface to clients, which recordings keep, too.
//!
//! Each conversion back gives `None` for what the brain would refuse.

use brain::{CleaningOrder, HomePart, MapEdit, NoGo, Pattern, PlaceShape, Zone};
use rvac_api::{CleaningPattern, JobOrder, JobPart, NoGoShape, RequestBody};

use crate::core::desk_request::{DeskRequest, body_of};
use crate::desk::words;

/// What a client asks for this edit.
#[must_use]
pub fn map_edit(edit: &MapEdit) -> RequestBody {
    body_of(edit)
}

/// The edit that this asks for; `None` for what asks for none.
#[must_use]
pub fn to_map_edit(body: RequestBody) -> Option<MapEdit> {
    match DeskRequest::of(body) {
        Ok(DeskRequest::Home(asked)) => Some(asked.edit),
        Ok(_) | Err(_) => None,
    }
}

/// An order without its power, which clients send in shares.
#[must_use]
pub fn order(order: &CleaningOrder) -> JobOrder {
    JobOrder {
        parts: order.parts().iter().map(part).collect(),
        passes: order.passes(),
        avoid: order.avoid().iter().map(no_go).collect(),
        power: None,
        pattern: order.pattern().map(pattern),
    }
}

/// The order of this form.
#[must_use]
pub fn to_order(order: &JobOrder) -> Option<CleaningOrder> {
    words::to_order(order).ok()
}

fn part(part: &HomePart) -> JobPart {
    match part {
        HomePart::Room(id) => JobPart::Room(*id),
        HomePart::Zone(zone) => JobPart::Zone(corners(zone)),
        HomePart::Spot(middle) => JobPart::Spot([middle.x_m, middle.y_m]),
    }
}

fn corners(zone: &Zone) -> Vec<[f64; 2]> {
    let corners = zone.corners().iter();
    corners.map(|corner| [corner.x_m, corner.y_m]).collect()
}

/// What is forbidden.
pub(crate) fn no_go(no_go: &NoGo) -> NoGoShape {
    match no_go.shape() {
        brain::NoGoShape::Zone => NoGoShape::Zone(corners(no_go.area())),
        brain::NoGoShape::Wall { from, to } => NoGoShape::Wall([[from.x_m, from.y_m], [to.x_m, to.y_m]]),
    }
}

/// Where a place is.
pub(crate) fn place(shape: &PlaceShape) -> rvac_api::PlaceShape {
    match shape {
        PlaceShape::Zone(zone) => rvac_api::PlaceShape::Zone(corners(zone)),
        PlaceShape::Spot(middle) => rvac_api::PlaceShape::Spot([middle.x_m, middle.y_m]),
    }
}

/// The pattern in which floor is swept.
pub(crate) const fn pattern(pattern: Pattern) -> CleaningPattern {
    match pattern {
        Pattern::Lines => CleaningPattern::Lines,
        Pattern::Contour => CleaningPattern::Contour,
    }
}
