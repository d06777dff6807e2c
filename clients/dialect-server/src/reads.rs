//! What clients may read, as JSON.

use dialect::Operation;
use jiff::Timestamp;
use rvac_api::{ComponentHealth, HomeView, KeptMap, RequestBody};
use serde_json::{Value, json};

use crate::capabilities::Capability;
use crate::site::Store;

/// A job cleans each part so often at most, and has so many parts at most.
const PASSES_MAX: u8 = 3;
const ZONES_MAX: u8 = 32;
/// At this load over the usual one the daemon calls a part hard to turn.
const HARD_SHARE: f64 = 1.4;

/// A part whose wear is told, in the words of the dialect, and its motors.
#[derive(Debug)]
pub(crate) struct Consumable {
    pub(crate) kind: &'static str,
    pub(crate) sub_kind: &'static str,
    pub(crate) components: &'static [&'static str],
}

/// Both wheels are one part to clean.
pub(crate) const CONSUMABLES: [Consumable; 5] = [
    Consumable {
        kind: "brush",
        sub_kind: "main",
        components: &["brush-main"],
    },
    Consumable {
        kind: "cleaning",
        sub_kind: "wheel",
        components: &["wheel-left", "wheel-right"],
    },
    Consumable {
        kind: "brush",
        sub_kind: "side_right",
        components: &["brush-sides"],
    },
    Consumable {
        kind: "filter",
        sub_kind: "main",
        components: &["filter"],
    },
    Consumable {
        kind: "cleaning",
        sub_kind: "sensor",
        components: &["sensors"],
    },
];

/// What the daemon is asked when a client resets such a part: what is weighed learns its load anew, and the hours of what has hours begin
/// anew.
pub(crate) fn resets(components: &[&str]) -> Vec<RequestBody> {
    let mut all = Vec::new();
    for component in components {
        let component = (*component).to_owned();
        let is_weighed = matches!(component.as_str(), "brush-main" | "wheel-left" | "wheel-right");
        let has_hours = !component.starts_with("wheel");
        if is_weighed {
            let component = component.clone();
            all.push(RequestBody::ResetHealth { component });
        }
        if has_hours {
            all.push(RequestBody::RenewPart { component });
        }
    }
    all
}

/// The whole state, of texts that are JSON already.
pub(crate) fn state_text(attributes: &str, map: &str) -> String {
    format!(r#"{{"__class":"RobotState","metaData":{{"version":1}},"attributes":{attributes},"map":{map}}}"#)
}

/// What the robot is.
pub(crate) fn robot(store: &Store) -> Value {
    let device = store.known.device.as_ref();
    let watches_box = device.is_some_and(|device| device.dust_box.is_some());
    let attachments: &[&str] = if watches_box { &["dustbin"] } else { &[] };
    let robot = store.known.robot.as_ref();
    json!({
        "manufacturer": "LibreRVAC",
        "modelName": robot.map_or("unknown", |robot| robot.device.as_str()),
        "modelDetails": {"supportedAttachments": attachments, "supportedDockComponents": []},
        "implementation": "LibreRVAC",
    })
}

/// Versions.
pub(crate) fn properties(store: &Store) -> Value {
    let versions = &store.known.versions;
    json!({"firmwareVersion": versions.firmware.as_deref().unwrap_or("unknown"), "metaData": versions})
}

/// Who serves this.
pub(crate) fn server(id: &str) -> Value {
    json!({"embedded": true, "systemId": id, "implementation": "LibreRVAC"})
}

pub(crate) fn version() -> Value {
    json!({"release": concat!("LibreRVAC ", env!("CARGO_PKG_VERSION")), "commit": "unknown"})
}

/// The document of a capability; `None` where there is none at this place.
pub(crate) fn capability(capability: Capability, rest: &str, store: &Store) -> Option<Value> {
    let home = store.known.home.as_ref();
    Some(match (capability, rest) {
        (Capability::FanSpeed, "presets") => {
            let names = bridge::FanSpeed::ALL.map(dialect::preset);
            json!(names)
        }
        (Capability::Segmentation, "") => home.map_or_else(|| json!([]), segments),
        (Capability::Segmentation, "properties") => json!({
            "iterationCount": {"min": 1, "max": PASSES_MAX},
            "customOrderSupport": true,
            "customOrderSupported": true,
        }),
        (Capability::Zones, "properties") => json!({
            "zoneCount": {"min": 1, "max": ZONES_MAX},
            "iterationCount": {"min": 1, "max": PASSES_MAX},
        }),
        (Capability::Restrictions, "") => match (home, home.and_then(dialect::Frame::around)) {
            (Some(home), Some(frame)) => dialect::restrictions(home, frame),
            _ => json!({"virtualWalls": [], "restrictedZones": []}),
        },
        (Capability::Consumables, "") => CONSUMABLES
            .iter()
            .filter_map(|part| consumable(part, &store.wear))
            .collect(),
        (Capability::CurrentStatistics, "") => current_statistics(store),
        (Capability::TotalStatistics, "") => total_statistics(store),
        (Capability::ManualControl, "properties") => json!({}),
        _ => return None,
    })
}

fn segments(home: &HomeView) -> Value {
    let all = dialect::segments(home);
    all.iter()
        .map(|(id, name)| {
            json!({"__class": "ValetudoMapSegment", "metaData": {}, "id": id, "name": name, "material": "generic"})
        })
        .collect()
}

/// How far a part is from where the daemon calls it hard to turn; where its load is not known, how many minutes of work are left until such
/// parts are usually seen to; nothing while neither is known.
fn consumable(part: &Consumable, wear: &[ComponentHealth]) -> Option<Value> {
    let worn = || {
        wear.iter()
            .filter(|worn| part.components.contains(&worn.component.as_str()))
    };
    let share = worn().filter_map(|worn| worn.share).reduce(f64::max);
    let hours = worn().find_map(|worn| worn.hours);
    let remaining = match (share, hours) {
        (Some(share), _) => {
            let left = ((HARD_SHARE - share) / (HARD_SHARE - 1.0)).clamp(0.0, 1.0);
            json!({"value": whole(left * 100.0), "unit": "percent"})
        }
        (None, Some(hours)) => {
            json!({"value": whole((hours.usual_h - hours.worked_h).max(0.0) * 60.0), "unit": "minutes"})
        }
        (None, None) => return None,
    };
    Some(json!({
        "__class": "ConsumableStateAttribute",
        "metaData": {},
        "type": part.kind,
        "subType": part.sub_kind,
        "remaining": remaining,
    }))
}

/// All numbers of the dialect are whole.
#[expect(
    clippy::cast_possible_truncation,
    reason = "it is held within a range before, and NaN becomes 0"
)]
fn whole(value: f64) -> i64 {
    value.round().clamp(0.0, 1e15) as i64
}

fn statistics(figures: &[(&str, f64)]) -> Value {
    let timestamp = Timestamp::now().to_string();
    figures
        .iter()
        .map(|(kind, value)| {
            json!({"__class": "ValetudoDataPoint", "metaData": {}, "timestamp": timestamp, "type": kind, "value": whole(*value)})
        })
        .collect()
}

fn current_statistics(store: &Store) -> Value {
    match &store.known.status {
        None => json!([]),
        Some(status) => {
            let done = dialect::progress(status);
            statistics(&[("time", done.time_s), ("area", done.area_cm2)])
        }
    }
}

fn total_statistics(store: &Store) -> Value {
    let Some(sums) = &store.totals else {
        return json!([]);
    };
    let count: u64 = sums.runs.values().sum();
    statistics(&[
        ("time", sums.moving_h * 3_600.0),
        ("area", sums.swept_m2 * 1e4),
        ("count", count as f64),
    ])
}

/// The versions of the map that the daemon keeps.
pub(crate) fn snapshots(maps: &[KeptMap]) -> Value {
    maps.iter()
        .map(|map| {
            let kept = i64::try_from(map.kept_s)
                .ok()
                .and_then(|kept_s| Timestamp::from_second(kept_s).ok());
            let kept = kept.unwrap_or(Timestamp::UNIX_EPOCH);
            json!({
                "__class": "ValetudoMapSnapshot",
                "metaData": {},
                "id": map.number.to_string(),
                "timestamp": kept.to_string(),
            })
        })
        .collect()
}

/// What the four buttons are called.
pub(crate) const OPERATIONS: &str = "start, stop, pause, home";

/// The operation of `action`.
pub(crate) fn operation(body: &Value) -> Option<Operation> {
    Operation::named(body.get("action")?.as_str()?)
}

#[cfg(test)]
mod tests {
    use rvac_api::{ComponentHealth, KeptMap, PartHours, RequestBody};
    use serde_json::json;

    use super::{CONSUMABLES, consumable, resets, snapshots};

    #[test]
    fn a_part_without_a_measured_load_has_minutes_left_and_a_reset_begins_its_hours_anew() {
        let filter = ComponentHealth {
            component: "filter".to_owned(),
            hours: Some(PartHours {
                worked_h: 149.5,
                usual_h: 150.0,
                ..PartHours::default()
            }),
            ..ComponentHealth::default()
        };
        let part = CONSUMABLES
            .iter()
            .find(|part| part.kind == "filter")
            .expect("is listed");
        let told = consumable(part, &[filter]).expect("is known");
        assert_eq!(told["remaining"], json!({"value": 30, "unit": "minutes"}));
        let component = || "filter".to_owned();
        assert_eq!(
            resets(part.components),
            [RequestBody::RenewPart {
                component: component()
            }]
        );
        assert_eq!(resets(&["wheel-left", "wheel-right"]).len(), 2);
        assert_eq!(resets(&["brush-main"]).len(), 2, "its load and its hours");
    }

    #[test]
    fn wear_is_what_is_left_until_it_is_hard_and_the_worse_wheel_counts() {
        let worn = |component: &str, share| ComponentHealth {
            component: component.to_owned(),
            share,
            ..ComponentHealth::default()
        };
        let wear = [
            worn("brush-main", Some(0.9)),
            worn("wheel-left", Some(1.1)),
            worn("wheel-right", Some(1.3)),
        ];
        let left = |wear: &[ComponentHealth], part: usize| {
            consumable(&CONSUMABLES[part], wear).map(|told| told["remaining"]["value"].to_string())
        };
        assert_eq!(left(&wear, 0).as_deref(), Some("100"));
        assert_eq!(left(&wear, 1).as_deref(), Some("25"));
        assert_eq!(left(&[worn("brush-main", None)], 0), None, "nothing is known yet");
    }

    #[test]
    fn a_kept_map_has_its_number_and_its_time() {
        let told = snapshots(&[KeptMap {
            number: 12,
            kept_s: 1_700_000_000,
            area_m2: 10.0,
            rooms: 2,
            doubted: false,
            last_good: false,
        }]);
        assert_eq!(told[0]["id"], "12");
        assert_eq!(told[0]["timestamp"], "2023-11-14T22:13:20Z");
    }
}
