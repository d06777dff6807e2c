//! The topics and maps that Valetudo's clients read, under a prefix that the owner chooses: for map cards and parsers that know no other form.
//! Formats are facts of an interface; no code is taken, and the robot never claims to be one of Valetudo's.

mod map;
mod orders;

use std::collections::BTreeMap;
use std::time::Duration;

use bridge::picture::{self, Chunk};
use bridge::{Change, Knowledge};
use rvac_api::{Activity, RequestBody, Status, Trouble, Update, explain};
use serde_json::{Value, json};

use crate::configuration::Configuration;
use crate::fan_speed::FanSpeed;
use crate::limiter::Limiter;
use crate::voice::{Output, Voice};
use crate::wire::{Incoming, Publish};
use map::Frame;

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
            let level = (battery.charge * 100.0).round();
            self.say("BatteryStateAttribute/level", level.to_string(), out);
            let flag = match battery.state.as_str() {
                "charging" => "charging",
                "full" => "charged",
                "discharging" => "discharging",
                _ => "none",
            };
            self.say("BatteryStateAttribute/status", flag, out);
        }
        self.say(
            "FanSpeedControlCapability/preset",
            orders::preset(self.speed),
            out,
        );
        let rooms = self
            .known
            .home
            .as_ref()
            .map(map::segments)
            .filter(|rooms| !rooms.is_empty());
        if let Some(rooms) = rooms {
            self.say("MapData/segments", Value::Object(rooms).to_string(), out);
        }
    }

    fn say_status(&mut self, status: &Status, out: &mut Vec<Output>) {
        let activity = Activity::from_name(&status.state);
        let trouble = Trouble::of_status(status);
        if let Some(activity) = activity {
            let words = activity.words();
            self.say("StatusStateAttribute/status", words.status_value, out);
            self.say("StatusStateAttribute/flag", words.status_flag, out);
        }
        let failed = trouble.filter(|_| activity.is_some_and(Activity::needs_help));
        let text = failed.map_or("No error", |(code, _)| {
            explain(code).map_or(code, |told| told.cause)
        });
        self.say("StatusStateAttribute/error_description", text, out);
        let error = failed.map_or(Value::Null, |(code, trouble)| {
            let words = trouble.words();
            json!({
                "severity": {"kind": "unknown", "level": words.gravity.level()},
                "subsystem": words.subsystem,
                "message": text,
                "vendorErrorCode": code,
            })
        });
        self.say("StatusStateAttribute/error", error.to_string(), out);
        // Square centimetres and seconds, by and by: ten seconds and a tenth of a square metre are fine enough.
        let area_cm2 = (status.swept_m2 * 10.0).floor() * 1_000.0;
        let time_s = (status.job_s / 10.0).floor() * 10.0;
        self.say("CurrentStatisticsCapability/area", area_cm2.to_string(), out);
        self.say("CurrentStatisticsCapability/time", time_s.to_string(), out);
    }

    fn say_map(&mut self, out: &mut Vec<Output>) {
        let Some((frame, map)) = map::map(&self.known) else {
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

/// Nodes of the convention *Homie*, version 4.
const NODES: [&str; 9] = [
    "StatusStateAttribute",
    "BatteryStateAttribute",
    "CurrentStatisticsCapability",
    "BasicControlCapability",
    "FanSpeedControlCapability",
    "MapSegmentationCapability",
    "ZoneCleaningCapability",
    "LocateCapability",
    "MapData",
];

impl Voice for Dialect {
    const NAME: &'static str = "-dialect";

    fn will(&self) -> Publish {
        self.kept("$state", b"lost".to_vec())
    }

    fn heard_topics(&self) -> Vec<String> {
        let topics = orders::TOPICS.map(|topic| format!("{}/{topic}", self.base));
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
        match orders::read(topic, &message.payload, self.frame.as_ref()) {
            Some(orders::DialectOrder::Speed(speed)) => {
                self.speed = speed;
                self.say_changes(out);
            }
            Some(orders::DialectOrder::Clean(order)) => {
                let power = order.power.or(self.speed.power());
                out.push(Output::Ask(RequestBody::Clean(rvac_api::JobOrder {
                    power,
                    ..order
                })));
            }
            Some(orders::DialectOrder::Ask(RequestBody::Start { .. })) => {
                let status = self.known.status.as_ref();
                let waits = status.is_some_and(|status| status.state == Activity::Paused.name());
                let start = match self.speed.power() {
                    _ if waits => RequestBody::Resume,
                    None => RequestBody::Start { strategy: None },
                    power => RequestBody::Clean(rvac_api::JobOrder {
                        power,
                        ..rvac_api::JobOrder::default()
                    }),
                };
                out.push(Output::Ask(start));
            }
            Some(orders::DialectOrder::Ask(body)) => out.push(Output::Ask(body)),
            None => tracing::warn!(topic, "a message is no command and is passed over"),
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
