//! Commands of the dialect. Whatever is not exactly one is none.

use bridge::{FanSpeed, Knowledge};
use rvac_api::{Activity, JobOrder, JobPart, RequestBody, RoomNaming, RoomSplitting};
use serde_json::Value;

use crate::body::{BodyError, field, list, place, room, room_part, wrong};
use crate::map::Frame;

/// Names of rooms are shorter than this; the daemon says how long they may be.
const NAME_BYTES_MAX: usize = 400;

/// What the four buttons of every vacuum ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// Clean, or go on.
    Start,
    /// End the job.
    Stop,
    /// Let the job wait.
    Pause,
    /// Go to the dock.
    Home,
}

impl Operation {
    const ALL: [(&'static str, Self); 4] = [
        ("start", Self::Start),
        ("stop", Self::Stop),
        ("pause", Self::Pause),
        ("home", Self::Home),
    ];

    /// The one with exactly this word, in small letters.
    #[must_use]
    pub fn named(word: &str) -> Option<Self> {
        let row = Self::ALL.into_iter().find(|(known, _)| *known == word);
        row.map(|(_, operation)| operation)
    }

    /// What the daemon is asked. A job that waits goes on by `start`.
    #[must_use]
    pub fn request(self, known: &Knowledge, speed: FanSpeed) -> RequestBody {
        let state = known.status.as_ref().map(|status| status.state.as_str());
        match self {
            Self::Stop => RequestBody::Stop,
            Self::Pause => RequestBody::Pause,
            Self::Home => RequestBody::Dock,
            Self::Start if state == Some(Activity::Paused.name()) => RequestBody::Resume,
            Self::Start if speed.power().is_none() => RequestBody::Start { strategy: None },
            Self::Start => with_speed(JobOrder::default(), speed),
        }
    }
}

/// The name of a preset: those of the others' list where there is one that fits.
#[must_use]
pub const fn preset(speed: FanSpeed) -> &'static str {
    match speed {
        FanSpeed::Rooms => "custom",
        FanSpeed::Quiet => "low",
        FanSpeed::Normal => "medium",
        FanSpeed::Full => "max",
    }
}

/// The preset of exactly this name.
#[must_use]
pub fn preset_named(name: &str) -> Option<FanSpeed> {
    FanSpeed::ALL.into_iter().find(|speed| preset(*speed) == name)
}

/// The request for a job, as hard as the preset says where the order says nothing.
#[must_use]
pub fn with_speed(order: JobOrder, speed: FanSpeed) -> RequestBody {
    let power = order.power.or(speed.power());
    RequestBody::Clean(JobOrder { power, ..order })
}

/// To clean rooms.
///
/// # Errors
/// [`BodyError`].
pub fn clean_segments(body: &Value) -> Result<JobOrder, BodyError> {
    let ids = list(body, "segment_ids")?;
    job(body, ids.iter().map(room_part).collect::<Result<_, _>>()?)
}

/// To clean zones.
///
/// # Errors
/// [`BodyError`].
pub fn clean_zones(body: &Value, frame: Option<&Frame>) -> Result<JobOrder, BodyError> {
    let frame = *frame.ok_or(BodyError::NoMap)?;
    let zone = |zone: &Value| {
        let points = field(zone, "points")?;
        let corners: Result<Vec<[f64; 2]>, _> = ["pA", "pB", "pC", "pD"]
            .into_iter()
            .map(|corner| place(points, corner, frame))
            .collect();
        corners.map(JobPart::Zone)
    };
    let zones = list(body, "zones")?;
    job(body, zones.iter().map(zone).collect::<Result<_, _>>()?)
}

/// To go to a place.
///
/// # Errors
/// [`BodyError`].
pub fn go_to(body: &Value, frame: Option<&Frame>) -> Result<RequestBody, BodyError> {
    let frame = *frame.ok_or(BodyError::NoMap)?;
    let [x, y] = place(body, "coordinates", frame)?;
    Ok(RequestBody::GoTo { x, y })
}

fn job(body: &Value, parts: Vec<JobPart>) -> Result<JobOrder, BodyError> {
    if parts.is_empty() {
        return Err(wrong("the list", "of one part at least"));
    }
    let passes = match body.get("iterations") {
        None => 1,
        Some(passes) => passes
            .as_u64()
            .and_then(|passes| u8::try_from(passes).ok())
            .ok_or(wrong("iterations", "a whole number"))?,
    };
    Ok(JobOrder {
        parts,
        passes,
        ..JobOrder::default()
    })
}

/// To make two rooms one.
///
/// # Errors
/// [`BodyError`].
pub fn join_segments(body: &Value) -> Result<RequestBody, BodyError> {
    let one = |name: &'static str| room(field(body, name)?, name);
    let rooms = [one("segment_a_id")?, one("segment_b_id")?];
    Ok(RequestBody::JoinRooms { rooms })
}

/// To cut a room in two.
///
/// # Errors
/// [`BodyError`].
pub fn split_segment(body: &Value, frame: Option<&Frame>) -> Result<RequestBody, BodyError> {
    let frame = *frame.ok_or(BodyError::NoMap)?;
    Ok(RequestBody::SplitRoom(RoomSplitting {
        room: Some(room(field(body, "segment_id")?, "segment_id")?),
        line: [place(body, "pA", frame)?, place(body, "pB", frame)?],
    }))
}

/// To name a room; an empty name takes it away.
///
/// # Errors
/// [`BodyError`].
pub fn rename_segment(body: &Value) -> Result<RequestBody, BodyError> {
    let name = field(body, "name")?.as_str();
    let name = name
        .filter(|name| name.len() <= NAME_BYTES_MAX)
        .ok_or(wrong("name", "a short text"))?;
    Ok(RequestBody::NameRoom(RoomNaming {
        room: room(field(body, "segment_id")?, "segment_id")?,
        name: (!name.is_empty()).then(|| name.to_owned()),
    }))
}

/// Where a stick is held: forward and turn to the left, each -1..=1. The dialect gives the speed ahead and an angle clockwise from ahead.
///
/// # Errors
/// [`BodyError`].
pub fn stick(body: &Value) -> Result<[f64; 2], BodyError> {
    let vector = field(body, "vector")?;
    let part = |name: &'static str, limit: f64, expected: &'static str| {
        let value = field(vector, name)?.as_f64();
        value
            .filter(|value| value.abs() <= limit)
            .ok_or(wrong(name, expected))
    };
    let velocity = part("velocity", 1.0, "a number from -1 to 1")?;
    let angle_deg = part("angle", 180.0, "a number from -180 to 180")?;
    Ok([velocity, (-angle_deg / 90.0).clamp(-1.0, 1.0)])
}

#[cfg(test)]
mod tests {
    use bridge::{FanSpeed, Knowledge};
    use rvac_api::{CleaningPower, JobOrder, JobPart, RequestBody, Status, Update};
    use serde_json::{Value, json};

    use super::{Operation, clean_segments, clean_zones, preset, preset_named, stick};
    use crate::BodyError;

    #[test]
    fn start_goes_on_with_a_job_that_waits_and_cleans_as_hard_as_the_preset_says() {
        let mut known = Knowledge::default();
        let start = |known: &Knowledge, speed| Operation::Start.request(known, speed);
        assert_eq!(
            start(&known, FanSpeed::Rooms),
            RequestBody::Start { strategy: None }
        );
        let quiet = JobOrder {
            power: Some(CleaningPower::QUIET),
            ..JobOrder::default()
        };
        assert_eq!(start(&known, FanSpeed::Quiet), RequestBody::Clean(quiet));
        known.take(&Update::Status(Status {
            state: "paused".to_owned(),
            ..Status::default()
        }));
        assert_eq!(start(&known, FanSpeed::Quiet), RequestBody::Resume);
        assert_eq!(Operation::named("START"), None);
        for speed in FanSpeed::ALL {
            assert_eq!(preset_named(preset(speed)), Some(speed));
        }
    }

    #[test]
    fn rooms_come_as_numbers_or_texts_and_nothing_else_is_one() {
        let order = clean_segments(&json!({"segment_ids": ["2", 3], "iterations": 2, "customOrder": true}))
            .expect("an order");
        assert_eq!(
            (order.parts, order.passes),
            (vec![JobPart::Room(2), JobPart::Room(3)], 2)
        );
        for wrong in [
            json!({}),
            json!([]),
            json!({"segment_ids": []}),
            json!({"segment_ids": [1.5]}),
            json!({"segment_ids": ["x"]}),
            json!({"segment_ids": [0]}),
            json!({"segment_ids": [70_000]}),
            json!({"segment_ids": [1], "iterations": -1}),
        ] {
            assert!(clean_segments(&wrong).is_err(), "{wrong}");
        }
        let zones = json!({"zones": [{"points": {}}]});
        assert_eq!(clean_zones(&zones, None), Err(BodyError::NoMap));
    }

    #[test]
    fn a_stick_turns_against_the_clock_and_has_limits() {
        let held =
            |velocity: Value, angle: Value| stick(&json!({"vector": {"velocity": velocity, "angle": angle}}));
        assert_eq!(held(json!(0.5), json!(-45)), Ok([0.5, 0.5]));
        assert_eq!(held(json!(-1), json!(135)), Ok([-1.0, -1.0]));
        for (velocity, angle) in [
            (json!(1.01), json!(0)),
            (json!(0), json!(181)),
            (json!("1"), json!(0)),
            (json!(null), json!(0)),
        ] {
            assert!(held(velocity, angle).is_err());
        }
    }
}
