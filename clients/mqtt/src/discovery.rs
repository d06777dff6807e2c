//! How Home Assistant finds the robot: one message that describes the whole device and each of its entities.
//!
//! A part that this robot lacks stands there with its platform alone, by which Home Assistant removes what an earlier message said.

use bridge::{FanSpeed, Knowledge};
use rvac_api::{Activity, ComponentHealth, RunResult, Trouble};
use serde_json::{Map, Value, json};

use crate::configuration::Configuration;
use crate::documents::run_event;
use crate::topics::{Hearing, Saying, Topics};

/// Parts whose wear the daemon can measure.
const WORN_PARTS: [(&str, &str); 3] = [
    ("brush-main", "Main brush"),
    ("wheel-left", "Left wheel"),
    ("wheel-right", "Right wheel"),
];

/// Parts whose hours of work the daemon counts: keys of the figure and of its button, component, name, and what is done with them.
const HOURLY_PARTS: [(&str, &str, &str, &str, &str); 4] = [
    (
        "hours_brush",
        "hours_brush_renew",
        "brush-main",
        "Main brush",
        "replaced",
    ),
    (
        "hours_sides",
        "hours_sides_renew",
        "brush-sides",
        "Side brushes",
        "replaced",
    ),
    (
        "hours_filter",
        "hours_filter_renew",
        "filter",
        "Filter",
        "replaced",
    ),
    (
        "hours_sensors",
        "hours_sensors_renew",
        "sensors",
        "Sensors",
        "cleaned",
    ),
];

/// What the message is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Device<'a> {
    pub(crate) configuration: &'a Configuration,
    pub(crate) topics: &'a Topics,
    pub(crate) known: &'a Knowledge,
    pub(crate) wear: &'a [ComponentHealth],
}

/// An entity, before it has what all have.
struct Entity {
    key: &'static str,
    platform: &'static str,
    /// `None` when this robot has no such part.
    content: Option<Value>,
}

impl Device<'_> {
    /// Where the message goes.
    pub(crate) fn topic(&self) -> String {
        format!(
            "{}/device/{}/config",
            self.configuration.discovery, self.configuration.id
        )
    }

    /// The message; `None` before the robot has described itself: half a device would be taken for a whole one.
    pub(crate) fn message(&self) -> Option<Value> {
        let robot = self.known.robot.as_ref()?;
        self.known.device.as_ref()?;
        let id = &self.configuration.id;
        let versions = &self.known.versions;
        let name = self.configuration.name.clone();
        let mut components = Map::new();
        let entities = [
            self.vacuum(),
            self.pictures(),
            self.measurements(),
            self.figures_of_jobs(),
            self.events(),
            self.choices(),
            self.wear(),
            self.hours(),
        ];
        for entity in entities.into_iter().flatten() {
            components.insert(entity.key.to_owned(), entity.whole(id));
        }
        Some(json!({
            "device": {
                "identifiers": [format!("librervac_{id}")],
                "name": name.unwrap_or_else(|| format!("LibreRVAC {id}")),
                "manufacturer": "LibreRVAC",
                "model": robot.device,
                "sw_version": versions.vthal,
                "hw_version": versions.firmware,
            },
            "origin": {"name": "rvac-mqtt", "sw_version": env!("CARGO_PKG_VERSION")},
            "availability_topic": self.topics.of(Saying::Availability),
            "qos": 0,
            "components": components,
        }))
    }

    fn has(&self, part: &str) -> bool {
        let robot = self.known.robot.as_ref();
        robot.is_some_and(|robot| robot.parts.iter().any(|own| own == part))
    }

    fn vacuum(&self) -> Vec<Entity> {
        let mut features = vec![
            "start",
            "stop",
            "pause",
            "return_home",
            "status",
            "clean_spot",
            "send_command",
        ];
        if self.known.robot.as_ref().is_some_and(FanSpeed::is_had_by) {
            features.push("fan_speed");
        }
        if self.has("beeper") {
            features.push("locate");
        }
        let speeds: Vec<&str> = FanSpeed::ALL.iter().map(|speed| speed.name()).collect();
        vec![entity(
            "vacuum",
            "vacuum",
            json!({
                "name": null,
                "state_topic": self.topics.of(Saying::State),
                "command_topic": self.topics.of_command(Hearing::Command),
                "send_command_topic": self.topics.of_command(Hearing::Request),
                "set_fan_speed_topic": self.topics.of_command(Hearing::FanSpeed),
                "fan_speed_list": speeds,
                "supported_features": features,
                "clean_segments_command_topic": self.topics.of_command(Hearing::Rooms),
                "json_attributes_topic": self.topics.of(Saying::Readings),
            }),
        )]
    }

    fn pictures(&self) -> Vec<Entity> {
        let shown = self.configuration.map_every_s > 0;
        let map = json!({"name": "Map", "topic": self.topics.of(Saying::Map)});
        vec![optional("map", "camera", shown.then_some(map))]
    }

    fn reading(&self, name: &str, key: &str) -> Value {
        json!({
            "name": name,
            "state_topic": self.topics.of(Saying::Readings),
            "value_template": format!("{{{{ value_json.{key} }}}}"),
        })
    }

    fn measurements(&self) -> Vec<Entity> {
        let device = self.known.device.as_ref();
        let battery = device.and_then(|device| device.battery.as_ref());
        let charge = self
            .reading("Battery", "battery")
            .with("device_class", "battery")
            .with("unit_of_measurement", "%");
        let voltage = self
            .reading("Battery voltage", "voltage_v")
            .with("device_class", "voltage")
            .with("unit_of_measurement", "V");
        let pack = self
            .reading("Battery temperature", "pack_c")
            .with("device_class", "temperature")
            .with("unit_of_measurement", "°C");
        let charging = self
            .flag("Charging", "charging")
            .with("device_class", "battery_charging");
        let box_in = self.flag("Dust box", "dust_box");
        let link = self
            .reading("Bad packets", "link_bad_percent")
            .with("unit_of_measurement", "%")
            .with("entity_category", "diagnostic");
        let troubles: Vec<&str> = std::iter::once("none")
            .chain(Trouble::ALL.iter().map(|trouble| trouble.words().name))
            .collect();
        let error = self
            .reading("Error", "trouble")
            .with("device_class", "enum")
            .with("options", troubles)
            .with("json_attributes_topic", self.topics.of(Saying::Readings))
            .with(
                "json_attributes_template",
                "{{ {'code': value_json.code, 'text': value_json.text, 'remedy': value_json.remedy} | tojson }}",
            );
        let problem = json!({
            "name": "Problem",
            "device_class": "problem",
            "state_topic": self.topics.of(Saying::Readings),
            "value_template": "{{ 'OFF' if value_json.trouble == 'none' else 'ON' }}",
        });
        let temperature = battery.and_then(|battery| battery.temperature_c);
        vec![
            optional(
                "battery",
                "sensor",
                battery.map(|_| charge.with("state_class", "measurement")),
            ),
            optional(
                "voltage",
                "sensor",
                battery.map(|_| voltage.with("entity_category", "diagnostic")),
            ),
            optional(
                "pack",
                "sensor",
                temperature.map(|_| pack.with("entity_category", "diagnostic")),
            ),
            optional("charging", "binary_sensor", battery.map(|_| charging)),
            optional(
                "dust_box",
                "binary_sensor",
                device.and_then(|device| device.dust_box).map(|_| box_in),
            ),
            entity("error", "sensor", error),
            entity("problem", "binary_sensor", problem),
            entity("link", "sensor", link),
        ]
    }

    fn flag(&self, name: &str, key: &str) -> Value {
        json!({
            "name": name,
            "state_topic": self.topics.of(Saying::Readings),
            "value_template": format!("{{{{ 'ON' if value_json.{key} else 'OFF' }}}}"),
        })
    }

    fn figures_of_jobs(&self) -> Vec<Entity> {
        let activities: Vec<&str> = Activity::ALL.iter().map(|activity| activity.name()).collect();
        let activity = self
            .reading("Activity", "activity")
            .with("device_class", "enum")
            .with("options", activities);
        let last = json!({
            "name": "Last run",
            "state_topic": self.topics.of(Saying::LastRun),
            "value_template": "{{ value_json.event_type }}",
            "json_attributes_topic": self.topics.of(Saying::LastRun),
        });
        let with_unit = |name, key, unit: &str| self.reading(name, key).with("unit_of_measurement", unit);
        vec![
            entity("activity", "sensor", activity),
            entity("room", "sensor", self.reading("Room", "room")),
            entity("area", "sensor", with_unit("Cleaned area", "area_m2", "m²")),
            entity("time", "sensor", with_unit("Cleaning time", "job_min", "min")),
            entity("path", "sensor", with_unit("Distance", "path_m", "m")),
            entity("bumps", "sensor", self.reading("Bumps", "bumps")),
            entity("last_run", "sensor", last),
            entity("next_run", "sensor", self.reading("Next run", "next_run")),
        ]
    }

    fn events(&self) -> Vec<Entity> {
        let event = |key, name: &str, saying, types: Vec<&str>| {
            let content = json!({
                "name": name,
                "state_topic": self.topics.of(saying),
                "event_types": types,
            });
            entity(key, "event", content)
        };
        let ends = RunResult::ALL.into_iter().map(run_event).collect();
        vec![
            event(
                "room_entered",
                "Room entered",
                Saying::RoomEntered,
                vec!["entered"],
            ),
            event("run_ended", "Run ended", Saying::RunEnded, ends),
            event("refused", "Refused", Saying::Refused, vec!["refused"]),
        ]
    }

    fn choices(&self) -> Vec<Entity> {
        let floors = self.known.floors.as_ref();
        let names: Vec<String> = floors
            .iter()
            .flat_map(|floors| &floors.floors)
            .filter(|floor| !floor.removed)
            .map(rvac_api::FloorView::title)
            .collect();
        let floor = self
            .reading("Floor", "floor")
            .with("options", names.clone())
            .with("command_topic", self.topics.of_command(Hearing::Floor));
        let clear = json!({
            "name": "Clear error",
            "command_topic": self.topics.of_command(Hearing::Request),
            "payload_press": "{\"c\":\"clear\",\"reason\":\"\"}",
        });
        vec![
            optional("floor", "select", (names.len() > 1).then_some(floor)),
            entity("clear_error", "button", clear),
        ]
    }

    /// Hours of work left until such a part is usually seen to; below 0 it is due.
    fn hours(&self) -> Vec<Entity> {
        let mut entities = Vec::new();
        for (key, renew_key, part, name, done) in HOURLY_PARTS {
            let counted = self
                .wear
                .iter()
                .any(|worn| worn.component == part && worn.hours.is_some());
            let state = json!({
                "name": format!("{name} hours left"),
                "device_class": "duration",
                "unit_of_measurement": "h",
                "entity_category": "diagnostic",
                "state_topic": self.topics.of(Saying::Wear),
                "value_template": format!(
                    "{{{{ (value_json['{part}'].usual_h - value_json['{part}'].worked_h) | round(1) }}}}"
                ),
            });
            let renew = json!({
                "name": format!("{name} {} {done}", if name.ends_with('s') { "were" } else { "was" }),
                "entity_category": "config",
                "command_topic": self.topics.of_command(Hearing::WearRenew),
                "payload_press": part,
            });
            entities.push(optional(key, "sensor", counted.then_some(state)));
            entities.push(optional(renew_key, "button", counted.then_some(renew)));
        }
        entities
    }

    fn wear(&self) -> Vec<Entity> {
        let mut entities = Vec::new();
        for (part, name) in WORN_PARTS {
            let measured = self.wear.iter().any(|worn| worn.component == part);
            let state = json!({
                "name": format!("{name} wear"),
                "device_class": "enum",
                "options": ["learning", "fine", "hard", "light"],
                "entity_category": "diagnostic",
                "state_topic": self.topics.of(Saying::Wear),
                "value_template": format!("{{{{ value_json['{part}'].verdict }}}}"),
                "json_attributes_topic": self.topics.of(Saying::Wear),
                "json_attributes_template": format!("{{{{ value_json['{part}'] | tojson }}}}"),
            });
            let reset = json!({
                "name": format!("{name} was cleaned"),
                "entity_category": "config",
                "command_topic": self.topics.of_command(Hearing::WearReset),
                "payload_press": part,
            });
            let (state_key, reset_key) = match part {
                "brush-main" => ("wear_brush", "wear_brush_reset"),
                "wheel-left" => ("wear_left", "wear_left_reset"),
                _ => ("wear_right", "wear_right_reset"),
            };
            entities.push(optional(state_key, "sensor", measured.then_some(state)));
            entities.push(optional(reset_key, "button", measured.then_some(reset)));
        }
        entities
    }
}

/// One key more, so that entities read as lists.
trait With {
    fn with(self, key: &str, value: impl Into<Value>) -> Value;
}

impl With for Value {
    fn with(mut self, key: &str, value: impl Into<Value>) -> Value {
        if let Value::Object(object) = &mut self {
            object.insert(key.to_owned(), value.into());
        }
        self
    }
}

fn entity(key: &'static str, platform: &'static str, content: Value) -> Entity {
    optional(key, platform, Some(content))
}

fn optional(key: &'static str, platform: &'static str, content: Option<Value>) -> Entity {
    Entity {
        key,
        platform,
        content,
    }
}

impl Entity {
    fn whole(self, id: &str) -> Value {
        match self.content {
            None => json!({"platform": self.platform}),
            Some(content) => content
                .with("platform", self.platform)
                .with("unique_id", format!("librervac_{id}_{}", self.key)),
        }
    }
}

#[cfg(test)]
mod tests {
    use bridge::Knowledge;
    use rvac_api::{BatteryReading, DeviceTable, RobotDescription};

    use super::Device;
    use crate::topics::Topics;

    fn robot(parts: &[&str]) -> RobotDescription {
        RobotDescription {
            device: "sr8730".to_owned(),
            radius_m: 0.17,
            swath_m: 0.2,
            speed_max_m_per_s: 0.3,
            turn_max_rad_per_s: 2.0,
            proximity: 0,
            parts: parts.iter().map(|part| (*part).to_owned()).collect(),
            unguarded: Vec::new(),
            unmeasured: Vec::new(),
            lacking: Vec::new(),
        }
    }

    #[test]
    fn a_robot_offers_what_it_has_and_half_a_robot_offers_nothing() {
        let configuration: crate::configuration::Configuration =
            serde_json::from_str(r#"{"broker": "mqtt://b", "id": "robo"}"#).expect("a configuration");
        let topics = Topics::new("librervac", "robo");
        let mut known = Knowledge::default();
        let message = |known: &Knowledge| {
            Device {
                configuration: &configuration,
                topics: &topics,
                known,
                wear: &[],
            }
            .message()
        };
        assert!(message(&known).is_none());
        known.robot = Some(robot(&["beeper"]));
        assert!(message(&known).is_none(), "what it measures is not known yet");
        known.device = Some(DeviceTable::default());
        let poor = message(&known).expect("a device");
        assert_eq!(
            poor["components"]["battery"].to_string(),
            r#"{"platform":"sensor"}"#
        );
        let features = poor["components"]["vacuum"]["supported_features"].to_string();
        assert!(
            features.contains("locate") && !features.contains("fan_speed"),
            "{features}"
        );
        let battery = BatteryReading {
            charge: 0.5,
            voltage_v: 14.0,
            current_a: 0.0,
            temperature_c: None,
            state: "full".to_owned(),
            charger: None,
        };
        known.device = Some(DeviceTable {
            battery: Some(battery),
            ..DeviceTable::default()
        });
        let richer = message(&known).expect("a device");
        assert_eq!(
            richer["components"]["battery"]["unique_id"],
            "librervac_robo_battery"
        );
    }
}
