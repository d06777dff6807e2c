//! Reading of the bodies that clients send.

use rvac_api::JobPart;
use serde_json::Value;

use crate::Frame;

/// Why a body is no command.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BodyError {
    /// A field is absent.
    #[error("{0} is missing")]
    Missing(&'static str),
    /// A field is something else.
    #[error("{field} must be {expected}")]
    Wrong {
        /// Which.
        field: &'static str,
        /// What it may be.
        expected: &'static str,
    },
    /// Places belong to a map.
    #[error("there is no map yet, so that places mean nothing")]
    NoMap,
}

pub(crate) const fn wrong(field: &'static str, expected: &'static str) -> BodyError {
    BodyError::Wrong { field, expected }
}

pub(crate) fn field<'a>(body: &'a Value, name: &'static str) -> Result<&'a Value, BodyError> {
    body.get(name).ok_or(BodyError::Missing(name))
}

pub(crate) fn list<'a>(body: &'a Value, name: &'static str) -> Result<&'a [Value], BodyError> {
    let values = field(body, name)?.as_array();
    values.map(Vec::as_slice).ok_or(wrong(name, "a list"))
}

/// Numbers come as texts, too.
pub(crate) fn number(value: &Value) -> Option<f64> {
    let number = match value {
        Value::String(text) => text.parse().ok()?,
        value => value.as_f64()?,
    };
    f64::is_finite(number).then_some(number)
}

/// The identity of a room.
pub(crate) fn room(value: &Value, name: &'static str) -> Result<u16, BodyError> {
    let id = match value {
        Value::String(text) => text.parse().ok(),
        value => value.as_u64().and_then(|id| u16::try_from(id).ok()),
    };
    id.filter(|id| *id > 0)
        .ok_or(wrong(name, "the number of a segment"))
}

pub(crate) fn room_part(value: &Value) -> Result<JobPart, BodyError> {
    room(value, "segment_ids").map(JobPart::Room)
}

/// A place of our map, metres.
pub(crate) fn place(points: &Value, name: &'static str, frame: Frame) -> Result<[f64; 2], BodyError> {
    let point = field(points, name)?;
    let axis = |axis: &'static str| number(field(point, axis)?).ok_or(wrong(name, "a place of two numbers"));
    Ok(frame.to_m(axis("x")?, axis("y")?))
}
