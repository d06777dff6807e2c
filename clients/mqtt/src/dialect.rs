//! The topics that Valetudo's clients read, under a prefix that the owner chooses: for map cards and parsers that know no other form.

use std::collections::BTreeMap;
use std::time::Duration;

use bridge::picture::{self, Chunk};
use bridge::{Change, FanSpeed, Knowledge, Limiter};
use dialect::{BodyError, Fault, Frame, Operation};
use rvac_api::{RequestBody, Status, Update};
use serde_json::Value;

use crate::configuration::Configuration;
use crate::voice::{Output, Voice};
use crate::wire::{Incoming, Publish};

/// Longest command.
const COMMAND_BYTES_MAX: usize = 8 << 10;

const OPERATION: &str = "BasicControlCapability/operation/set";
const PRESET: &str = "FanSpeedControlCapability/preset/set";
const SEGMENTS: &str = "MapSegmentationCapability/clean/set";
const ZONES: &str = "ZoneCleaningCapability/start/set";
const LOCATE: &str = "LocateCapability/locate/set";
const GO_TO: &str = "GoToLocationCapability/go/set";

/// All topics on which commands come.
const TOPICS: [&str; 6] = [OPERATION, PRESET, SEGMENTS, ZONES, LOCATE, GO_TO];

/// Least pause between two maps.
const MAP_EVERY: Duration = Duration::from_secs(2);

/// The side that speaks the dialect.
#[derive(Debug)]
pub(crate) struct Dialect {
    base: String,
    takes_commands: bool,
    name: String,
    known: Knowledge,
    speed: FanSpeed,
    broker_is_up: bool,
    daemon_is_up: bool,
    said: BTreeMap<String, Vec<u8>>,
    /// Of the map that was said last: places in commands are in it.
    frame: Option<Frame>,
    map_is_new: bool,
    map_at: Option<Duration>,
    limiter: Limiter,
}

impl Dialect {
    pub(crate) fn new(configuration: &Configuration) -> Self {
        let name = configuration.name.clone();
        Self {
            base: format!("{}/{}", configuration.dialect_prefix, configuration.id),
            takes_commands: configuration.takes_commands(),
            name: name.unwrap_or_else(|| format!("LibreRVAC {}", configuration.id)),
            known: Knowledge::default(),
            speed: FanSpeed::default(),
            broker_is_up: false,
            daemon_is_up: false,
            said: BTreeMap::new(),
            frame: None,
            map_is_new: false,
            map_at: None,
            limiter: Limiter::default(),
        }
    }

    fn kept(&self, topic: &str, payload: Vec<u8>) -> Publish {
        Publish {
            topic: format!("{}/{topic}", self.base),
            payload,
            retain: true,
            acknowledged: true,
        }
    }

    fn say(&mut self, topic: &str, payload: impl Into<Vec<u8>>, out: &mut Vec<Output>) {
        let message = self.kept(topic, payload.into());
        if self.said.get(&message.topic) != Some(&message.payload) {
            self.said.insert(message.topic.clone(), message.payload.clone());
            out.push(Output::State(message));
        }
    }

    fn say_changes(&mut self, out: &mut Vec<Output>) {
        if !self.broker_is_up {
            return;
        }
        self.say("$homie", "4.0.0", out);
        self.say("$name", self.name.clone(), out);
        self.say("$nodes", NODES.join(","), out);
        let state = if self.daemon_is_up { "ready" } else { "lost" };
        self.say("$state", state, out);
        let Some(status) = self.known.status.clone() else {
            return;
        };
        self.say_status(&status, out);
        let battery = self
            .known
            .device
            .as_ref()
            .and_then(|device| device.battery.clone());
        if let Some(battery) = battery {
            let (level, flag) = dialect::battery(&battery);
            self.say("BatteryStateAttribute/level", level.to_string(), out);
            self.say("BatteryStateAttribute/status", flag, out);
        }
        self.say(
            "FanSpeedControlCapability/preset",
            dialect::preset(self.speed),
            out,
        );
        let rooms = self
            .known
            .home
            .as_ref()
            .map(dialect::segments)
            .filter(|rooms| !rooms.is_empty());
        if let Some(rooms) = rooms {
            self.say("MapData/segments", Value::Object(rooms).to_string(), out);
        }
    }

    fn say_status(&mut self, status: &Status, out: &mut Vec<Output>) {
        let words = dialect::status(status);
        if let Some(value) = words.value {
            self.say("StatusStateAttribute/status", value, out);
            self.say("StatusStateAttribute/flag", words.flag, out);
        }
        let fault = words.fault.as_ref();
        let text = fault.map_or("No error", Fault::text);
        self.say("StatusStateAttribute/error_description", text, out);
        let error = fault.map_or(Value::Null, Fault::json);
        self.say("StatusStateAttribute/error", error.to_string(), out);
        let done = dialect::progress(status);
        self.say("CurrentStatisticsCapability/area", done.area_cm2.to_string(), out);
        self.say("CurrentStatisticsCapability/time", done.time_s.to_string(), out);
    }

    fn say_map(&mut self, out: &mut Vec<Output>) {
        let Some((frame, map)) = dialect::map(&self.known) else {
            return;
        };
        self.frame = Some(frame);
        let packed = picture::deflated(map.to_string().as_bytes());
        let mut chunk = b"ValetudoMap\0\0".to_vec();
        chunk.extend_from_slice(&packed);
        let picture = picture::png(
            &self.known,
            &[Chunk {
                kind: *b"zTXt",
                data: &chunk,
            }],
        );
        for (topic, content) in [
            ("MapData/map-data", Some(packed)),
            ("MapData/map-data-hass", picture),
        ] {
            if let Some(content) = content {
                out.push(Output::State(Publish {
                    acknowledged: false,
                    ..self.kept(topic, content)
                }));
            }
        }
    }
}

/// What a command asks for.
#[derive(Clone, Debug, PartialEq)]
enum DialectOrder {
    /// To clean so from the next job on.
    Speed(FanSpeed),
    /// Anything else.
    Ask(RequestBody),
}

/// Why a message is no command.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
enum NoOrder {
    #[error("it is longer than {COMMAND_BYTES_MAX} bytes")]
    TooLong,
    #[error("it is none of the words that are known here")]
    Unknown,
    #[error("it is no JSON")]
    NoJson,
    #[error(transparent)]
    Body(#[from] BodyError),
}

impl Dialect {
    fn read(&self, topic: &str, payload: &[u8]) -> Result<DialectOrder, NoOrder> {
        if payload.len() > COMMAND_BYTES_MAX {
            return Err(NoOrder::TooLong);
        }
        let text = std::str::from_utf8(payload).map_err(|_| NoOrder::Unknown)?;
        let json = || serde_json::from_str(text).map_err(|_| NoOrder::NoJson);
        let frame = self.frame.as_ref();
        let job = |order| dialect::with_speed(order, self.speed);
        Ok(DialectOrder::Ask(match topic {
            OPERATION => operation(text)
                .ok_or(NoOrder::Unknown)?
                .request(&self.known, self.speed),
            PRESET => {
                let speed = dialect::preset_named(text).ok_or(NoOrder::Unknown)?;
                return Ok(DialectOrder::Speed(speed));
            }
            SEGMENTS => job(dialect::clean_segments(&json()?)?),
            ZONES => job(dialect::clean_zones(&json()?, frame)?),
            LOCATE if text == "PERFORM" => RequestBody::Locate,
            GO_TO => dialect::go_to(&json()?, frame)?,
            _ => return Err(NoOrder::Unknown),
        }))
    }
}

/// Over a broker the words are in capital letters.
fn operation(text: &str) -> Option<Operation> {
    let has_small = text.bytes().any(|byte| byte.is_ascii_lowercase());
    Operation::named(&text.to_ascii_lowercase()).filter(|_| !has_small)
}

/// Nodes of the convention *Homie*, version 4.
const NODES: [&str; 10] = [
    "StatusStateAttribute",
    "BatteryStateAttribute",
    "CurrentStatisticsCapability",
    "BasicControlCapability",
    "FanSpeedControlCapability",
    "MapSegmentationCapability",
    "ZoneCleaningCapability",
    "LocateCapability",
    "GoToLocationCapability",
    "MapData",
];

impl Voice for Dialect {
    const NAME: &'static str = "-dialect";

    fn will(&self) -> Publish {
        self.kept("$state", b"lost".to_vec())
    }

    fn heard_topics(&self) -> Vec<String> {
        let topics = TOPICS.map(|topic| format!("{}/{topic}", self.base));
        topics.into_iter().filter(|_| self.takes_commands).collect()
    }

    fn broker_came(&mut self, _now: Duration, out: &mut Vec<Output>) {
        self.broker_is_up = true;
        self.said.clear();
        self.map_at = None;
        self.map_is_new = true;
        self.say_changes(out);
    }

    fn broker_went(&mut self) {
        self.broker_is_up = false;
    }

    fn daemon_came(&mut self, _out: &mut Vec<Output>) {
        self.daemon_is_up = true;
    }

    fn daemon_went(&mut self, _now: Duration, out: &mut Vec<Output>) {
        self.daemon_is_up = false;
        self.known.forget_state();
        self.say_changes(out);
    }

    fn update(&mut self, update: &Update, _now: Duration, out: &mut Vec<Output>) {
        match self.known.take(update) {
            Change::Nothing => {}
            Change::Map => self.map_is_new = true,
            Change::Home => {
                self.map_is_new = true;
                self.say_changes(out);
            }
            _ => self.say_changes(out),
        }
        if self.known.wants_hello() {
            out.push(Output::Hello);
        }
    }

    fn message(&mut self, message: &Incoming, now: Duration, out: &mut Vec<Output>) {
        if message.retained || !self.takes_commands || !self.limiter.allows(now) {
            return;
        }
        let topic = message
            .topic
            .strip_prefix(&self.base)
            .and_then(|rest| rest.strip_prefix('/'));
        let Some(topic) = topic else { return };
        match self.read(topic, &message.payload) {
            Ok(DialectOrder::Speed(speed)) => {
                self.speed = speed;
                self.say_changes(out);
            }
            Ok(DialectOrder::Ask(body)) => out.push(Output::Ask(body)),
            Err(error) => tracing::warn!(topic, %error, "a message is no command and is passed over"),
        }
    }

    fn wake(&mut self, now: Duration, out: &mut Vec<Output>) {
        self.say_changes(out);
        let due = self.map_at.is_none_or(|at| now >= at + MAP_EVERY);
        if self.broker_is_up && self.map_is_new && due {
            self.map_is_new = false;
            self.map_at = Some(now);
            self.say_map(out);
        }
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::RequestBody;

    use super::{Dialect, DialectOrder, NoOrder, TOPICS};

    #[test]
    fn commands_are_exactly_what_they_are() {
        let configuration = r#"{"broker": "mqtt://b", "id": "robo", "dialect_prefix": "kaart"}"#;
        let dialect = Dialect::new(&serde_json::from_str(configuration).expect("a configuration"));
        let text = |topic: usize, text: &str| dialect.read(TOPICS[topic], text.as_bytes());
        assert_eq!(text(0, "HOME"), Ok(DialectOrder::Ask(RequestBody::Dock)));
        for wrong in ["home", "HOMe", "", "\u{1}"] {
            assert_eq!(text(0, wrong), Err(NoOrder::Unknown), "{wrong}");
        }
        assert_eq!(text(2, "]"), Err(NoOrder::NoJson));
        assert!(matches!(text(2, "{}"), Err(NoOrder::Body(_))));
        assert!(matches!(
            text(2, r#"{"segment_ids":["1"]}"#),
            Ok(DialectOrder::Ask(_))
        ));
        assert!(
            matches!(text(3, r#"{"zones":[{"points":{}}]}"#), Err(NoOrder::Body(_))),
            "there is no map yet"
        );
        assert_eq!(text(4, "PERFORM"), Ok(DialectOrder::Ask(RequestBody::Locate)));
        assert!(
            matches!(text(5, r#"{"coordinates":{"x":1,"y":2}}"#), Err(NoOrder::Body(_))),
            "there is no map yet"
        );
        assert_eq!(text(0, &" ".repeat(9_000)), Err(NoOrder::TooLong));
    }
}
