//! Commands of the dialect. Whatever is not exactly one is none.

use rvac_api::{JobOrder, JobPart, RequestBody};
use serde_json::Value;

use super::map::Frame;
use crate::fan_speed::FanSpeed;

/// Longest command.
const COMMAND_BYTES_MAX: usize = 8 << 10;

const OPERATION: &str = "BasicControlCapability/operation/set";
const PRESET: &str = "FanSpeedControlCapability/preset/set";
const SEGMENTS: &str = "MapSegmentationCapability/clean/set";
const ZONES: &str = "ZoneCleaningCapability/start/set";
const LOCATE: &str = "LocateCapability/locate/set";

/// All topics on which commands come.
pub(crate) const TOPICS: [&str; 5] = [OPERATION, PRESET, SEGMENTS, ZONES, LOCATE];

/// What a command asks for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum DialectOrder {
    /// To clean so from the next job on.
    Speed(FanSpeed),
    /// To clean this.
    Clean(JobOrder),
    /// Anything else.
    Ask(RequestBody),
}

/// The name of a preset: those of the others' list where there is one that fits.
pub(crate) const fn preset(speed: FanSpeed) -> &'static str {
    match speed {
        FanSpeed::Rooms => "custom",
        FanSpeed::Quiet => "low",
        FanSpeed::Normal => "medium",
        FanSpeed::Full => "max",
    }
}

/// Reads a command; places in it are those of the map of this frame.
pub(crate) fn read(topic: &str, payload: &[u8], frame: Option<&Frame>) -> Option<DialectOrder> {
    if payload.len() > COMMAND_BYTES_MAX {
        return None;
    }
    let text = std::str::from_utf8(payload).ok()?;
    match topic {
        OPERATION => Some(DialectOrder::Ask(match text {
            "START" => RequestBody::Start { strategy: None },
            "STOP" => RequestBody::Stop,
            "PAUSE" => RequestBody::Pause,
            "HOME" => RequestBody::Dock,
            _ => return None,
        })),
        PRESET => FanSpeed::ALL
            .into_iter()
            .find(|speed| preset(*speed) == text)
            .map(DialectOrder::Speed),
        SEGMENTS => segments(&serde_json::from_str(text).ok()?).map(DialectOrder::Clean),
        ZONES => zones(&serde_json::from_str(text).ok()?, *frame?).map(DialectOrder::Clean),
        LOCATE => (text == "PERFORM").then_some(DialectOrder::Ask(RequestBody::Locate)),
        _ => None,
    }
}

fn segments(body: &Value) -> Option<JobOrder> {
    let ids = body.get("segment_ids")?.as_array()?;
    let room = |id: &Value| {
        let id = number(id)?;
        let whole = (1.0..=f64::from(u16::MAX)).contains(&id) && id.fract() == 0.0;
        let id = format!("{id:.0}").parse().ok()?;
        whole.then_some(JobPart::Room(id))
    };
    order(body, ids.iter().map(room).collect())
}

fn zones(body: &Value, frame: Frame) -> Option<JobOrder> {
    let zones = body.get("zones")?.as_array()?;
    let zone = |zone: &Value| {
        let points = zone.get("points")?;
        let corner = |name: &str| {
            let point = points.get(name)?;
            Some(frame.to_m(number(point.get("x")?)?, number(point.get("y")?)?))
        };
        let corners: Option<Vec<[f64; 2]>> = ["pA", "pB", "pC", "pD"].into_iter().map(corner).collect();
        corners.map(JobPart::Zone)
    };
    order(body, zones.iter().map(zone).collect())
}

fn order(body: &Value, parts: Option<Vec<JobPart>>) -> Option<JobOrder> {
    let parts = parts.filter(|parts| !parts.is_empty())?;
    let passes = match body.get("iterations") {
        None => 1,
        Some(passes) => passes.as_u64().and_then(|passes| u8::try_from(passes).ok())?,
    };
    Some(JobOrder {
        parts,
        passes,
        ..JobOrder::default()
    })
}

/// Numbers come as texts, too.
fn number(value: &Value) -> Option<f64> {
    let number = match value {
        Value::String(text) => text.parse().ok()?,
        value => value.as_f64()?,
    };
    f64::is_finite(number).then_some(number)
}

#[cfg(test)]
mod tests {
    use rvac_api::{JobPart, RequestBody};

    use super::{DialectOrder, TOPICS, read};

    #[test]
    fn commands_are_exactly_what_they_are() {
        let text = |topic: &str, text: &str| read(topic, text.as_bytes(), None);
        assert_eq!(
            text(TOPICS[0], "HOME"),
            Some(DialectOrder::Ask(RequestBody::Dock))
        );
        assert_eq!(text(TOPICS[0], "home"), None);
        let rooms = text(
            TOPICS[2],
            r#"{"segment_ids":["2",3],"iterations":2,"customOrder":true}"#,
        );
        let Some(DialectOrder::Clean(order)) = rooms else {
            panic!("{rooms:?}");
        };
        assert_eq!(
            (order.parts, order.passes),
            (vec![JobPart::Room(2), JobPart::Room(3)], 2)
        );
        for wrong in [
            "{}",
            "[]",
            r#"{"segment_ids":[]}"#,
            r#"{"segment_ids":[1.5]}"#,
            r#"{"segment_ids":["x"]}"#,
            r#"{"segment_ids":[1],"iterations":-1}"#,
        ] {
            assert_eq!(text(TOPICS[2], wrong), None, "{wrong}");
        }
        assert_eq!(
            text(TOPICS[3], r#"{"zones":[{"points":{}}]}"#),
            None,
            "there is no map yet"
        );
    }
}
