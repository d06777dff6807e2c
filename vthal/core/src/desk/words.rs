//! Names, places and orders as clients send them, converted to the types of the brain.

use brain::zone::COORDINATE_MAX_M;
use brain::{CleaningOrder, EditError, HomePart, NoGo, Point2, RoomName, Zone};
use rvac_api::{JobOrder, JobPart, short_number};

use super::home::to_no_go;
use super::room_power::{to_pattern, to_power};
use crate::refusal::Refusal;

/// An order whose places are zones and spots by now.
pub(crate) fn to_order(order: &JobOrder) -> Result<CleaningOrder, Refusal> {
    let part = |(place, part): (usize, &JobPart)| match part {
        JobPart::Room(id) => Ok(HomePart::Room(*id)),
        JobPart::Zone(corners) => to_zone(&format!("Part {}", place + 1), corners).map(HomePart::Zone),
        JobPart::Spot([x_m, y_m]) => Ok(HomePart::Spot(Point2 { x_m: *x_m, y_m: *y_m })),
        JobPart::Place(_) => Err(EditError::NoSuchPlace.into()),
    };
    let parts: Result<Vec<HomePart>, Refusal> = order.parts.iter().enumerate().map(part).collect();
    let whole = CleaningOrder::new(parts?, order.passes).map_err(|reason| {
        let text = format!(
            "{} parts and {} passes were ordered: a job has up to 32 parts and 1 to 3 passes.",
            order.parts.len(),
            order.passes
        );
        Refusal::because(reason, text)
    })?;
    let avoid: Result<Vec<NoGo>, Refusal> = order.avoid.iter().map(to_no_go).collect();
    let whole = whole.avoiding(avoid?).map_err(|reason| {
        let text = format!(
            "{} places are to be avoided: a job keeps out of up to 16.",
            order.avoid.len()
        );
        Refusal::because(reason, text)
    })?;
    with_settings(whole, order)
}

/// An order with what it says of how it is carried out.
fn with_settings(whole: CleaningOrder, order: &JobOrder) -> Result<CleaningOrder, Refusal> {
    let whole = match order.pattern {
        Some(pattern) => whole.with_pattern(to_pattern(pattern)),
        None => whole,
    };
    match &order.power {
        Some(power) => Ok(whole.with_power(to_power(power)?)?),
        None => Ok(whole),
    }
}

pub(crate) fn to_zone(what: &str, corners: &[[f64; 2]]) -> Result<Zone, Refusal> {
    let points = corners.iter().map(|&[x_m, y_m]| Point2 { x_m, y_m });
    Zone::new(points.collect()).map_err(|reason| {
        if reason != EditError::BadZone {
            return Refusal::from(reason);
        }
        let far = corners
            .iter()
            .find(|[x, y]| !(x.abs() < COORDINATE_MAX_M && y.abs() < COORDINATE_MAX_M));
        let text = match far {
            Some(corner) => {
                let [x, y] = corner.map(short_number);
                format!("{what} has a corner at x {x} m, y {y} m: they must lie within {COORDINATE_MAX_M} m.")
            }
            None => format!(
                "{what} is a zone with {} corners: it must have 3 to 64.",
                corners.len()
            ),
        };
        Refusal::because(reason, text)
    })
}

pub(crate) fn to_name(text: &str) -> Result<RoomName, Refusal> {
    RoomName::new(text).map_err(|reason| {
        let text = format!(
            "The name has {} characters: it must be one line of 1 to 40.",
            text.trim().chars().count()
        );
        Refusal::because(reason, text)
    })
}
