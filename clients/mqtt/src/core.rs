//! What the bridge decides: updates of the daemon and messages of the broker go in, messages and requests come out. No I/O, no clock.

use std::collections::BTreeMap;
use std::time::Duration;

use bridge::{Change, FanSpeed, Knowledge, Limiter, picture};
use rvac_api::{Activity, ComponentHealth, JobOrder, RequestBody, Run, Trouble, Update};
use serde_json::{Value, json};

use crate::commands::{self, Order};
use crate::configuration::Configuration;
use crate::discovery::Device;
use crate::documents;
use crate::topics::{Hearing, Saying, Topics};
use crate::voice::{Output, Voice};
use crate::wire::{Incoming, Publish};

/// Least pause between readings that changed by and by, such as the swept area.
const READINGS_EVERY: Duration = Duration::from_secs(10);
/// Pause between questions about wear.
const WEAR_EVERY: Duration = Duration::from_secs(15 * 60);
/// The bridge.
#[derive(Debug)]
pub(crate) struct Core {
    configuration: Configuration,
    topics: Topics,
    known: Knowledge,
    speed: FanSpeed,
    wear: Vec<ComponentHealth>,
    last_run: Option<Run>,
    /// Room of the last event.
    room: Option<u16>,
    /// The daemon is there.
    daemon_is_up: bool,
    /// The broker is.
    broker_is_up: bool,
    /// What was said last, by topic, while the broker is there.
    said: BTreeMap<String, Vec<u8>>,
    events_said: Value,
    readings_at: Option<Duration>,
    map_is_new: bool,
    map_at: Option<Duration>,
    wear_at: Option<Duration>,
    limiter: Limiter,
}

impl Core {
    pub(crate) fn new(configuration: Configuration) -> Self {
        let topics = Topics::new(&configuration.prefix, &configuration.id);
        Self {
            configuration,
            topics,
            known: Knowledge::default(),
            speed: FanSpeed::default(),
            wear: Vec::new(),
            last_run: None,
            room: None,
            daemon_is_up: false,
            broker_is_up: false,
            said: BTreeMap::new(),
            events_said: Value::Null,
            readings_at: None,
            map_is_new: false,
            map_at: None,
            wear_at: None,
            limiter: Limiter::default(),
        }
    }

    /// Where Home Assistant says that it has started.
    fn birth_topic(&self) -> Option<String> {
        let prefix = &self.configuration.discovery;
        (!prefix.is_empty()).then(|| format!("{prefix}/status"))
    }

    fn say_all_anew(&mut self, now: Duration, out: &mut Vec<Output>) {
        self.said.clear();
        self.readings_at = None;
        self.map_at = None;
        self.map_is_new = true;
        self.say_changes(now, out);
    }

    fn watch_room(&mut self, out: &mut Vec<Output>) {
        let room = self.known.status.as_ref().and_then(|status| status.room.clone());
        let Some(room) = room else { return };
        let before = self.room.replace(room.id);
        if before.is_some_and(|before| before != room.id) {
            let event = json!({"event_type": "entered", "room": room.title(), "room_id": room.id});
            self.event(Saying::RoomEntered, &event, out);
        }
    }

    fn order(&mut self, order: Order, now: Duration, out: &mut Vec<Output>) {
        let body = match order {
            Order::Speed(speed) => {
                self.speed = speed;
                self.say_changes(now, out);
                return;
            }
            Order::Go => self.go(),
            Order::Clean(order) => RequestBody::Clean(self.with_power(order)),
            Order::Floor(name) => match self.floor(&name) {
                Some(floor) => RequestBody::ChooseFloor { floor },
                None => return,
            },
            Order::Ask(RequestBody::Clear { reason }) if reason.is_empty() => {
                let trouble = self.known.status.as_ref().and_then(Trouble::of_status);
                match trouble {
                    Some((code, _)) => RequestBody::Clear {
                        reason: code.to_owned(),
                    },
                    None => return,
                }
            }
            Order::Ask(body) => body,
        };
        let changes_wear = matches!(
            body,
            RequestBody::ResetHealth { .. }
                | RequestBody::RenewPart { .. }
                | RequestBody::UndoRenewPart { .. }
        );
        if changes_wear {
            self.wear_at = None;
        }
        out.push(Output::Ask(body));
    }

    fn go(&self) -> RequestBody {
        let status = self.known.status.as_ref();
        let activity = status.and_then(|status| Activity::from_name(&status.state));
        match (activity, self.speed.power()) {
            (Some(Activity::Paused), _) => RequestBody::Resume,
            (_, None) => RequestBody::Start { strategy: None },
            (_, Some(_)) => RequestBody::Clean(self.with_power(JobOrder::default())),
        }
    }

    fn with_power(&self, order: JobOrder) -> JobOrder {
        JobOrder {
            power: order.power.or(self.speed.power()),
            ..order
        }
    }

    fn floor(&self, name: &str) -> Option<u16> {
        let floors = self.known.floors.as_ref()?;
        let floor = floors
            .floors
            .iter()
            .find(|floor| !floor.removed && floor.title() == name)?;
        Some(floor.number)
    }

    fn map_is_due(&self, now: Duration) -> bool {
        let every = Duration::from_secs(self.configuration.map_every_s.into());
        let due = self.map_at.is_none_or(|at| now >= at + every);
        self.broker_is_up && self.map_is_new && !every.is_zero() && due
    }

    /// Says what is otherwise than it was said.
    fn say_changes(&mut self, now: Duration, out: &mut Vec<Output>) {
        if !self.broker_is_up {
            return;
        }
        let device = Device {
            configuration: &self.configuration,
            topics: &self.topics,
            known: &self.known,
            wear: &self.wear,
        };
        if !self.configuration.discovery.is_empty()
            && let Some(message) = device.message()
        {
            let topic = device.topic();
            self.say(topic, message.to_string().into_bytes(), out);
        }
        let available: &[u8] = if self.daemon_is_up { b"online" } else { b"offline" };
        self.say(self.topics.of(Saying::Availability), available.to_vec(), out);
        if !self.daemon_is_up || self.known.status.is_none() {
            return;
        }
        let state = documents::state(&self.known, self.speed);
        self.say(self.topics.of(Saying::State), state.to_string().into_bytes(), out);
        self.say_readings(now, out);
        if !self.wear.is_empty() {
            let wear = documents::wear(&self.wear);
            self.say(self.topics.of(Saying::Wear), wear.to_string().into_bytes(), out);
        }
        if let Some(run) = &self.last_run {
            let run = documents::run(run).to_string().into_bytes();
            self.say(self.topics.of(Saying::LastRun), run, out);
        }
    }

    fn say_readings(&mut self, now: Duration, out: &mut Vec<Output>) {
        let (events, all) = documents::readings(&self.known);
        let due = self.readings_at.is_none_or(|at| now >= at + READINGS_EVERY);
        if due || events != self.events_said {
            self.events_said = events;
            let before = out.len();
            self.say(
                self.topics.of(Saying::Readings),
                all.to_string().into_bytes(),
                out,
            );
            if out.len() > before {
                self.readings_at = Some(now);
            }
        }
    }

    fn say(&mut self, topic: String, payload: Vec<u8>, out: &mut Vec<Output>) {
        if self.said.get(&topic) == Some(&payload) {
            return;
        }
        out.push(Output::State(Publish {
            topic: topic.clone(),
            payload: payload.clone(),
            retain: true,
            acknowledged: true,
        }));
        self.said.insert(topic, payload);
    }

    fn state_message(&self, saying: Saying, payload: Vec<u8>) -> Publish {
        Publish {
            topic: self.topics.of(saying),
            payload,
            retain: true,
            acknowledged: true,
        }
    }

    fn event(&self, saying: Saying, content: &Value, out: &mut Vec<Output>) {
        if self.broker_is_up {
            out.push(Output::Event(Publish {
                retain: false,
                ..self.state_message(saying, content.to_string().into_bytes())
            }));
        }
    }
}

impl Voice for Core {
    const NAME: &'static str = "";

    fn will(&self) -> Publish {
        self.state_message(Saying::Availability, b"offline".to_vec())
    }

    fn heard_topics(&self) -> Vec<String> {
        let commands = Hearing::ALL.map(|hearing| self.topics.of_command(hearing));
        let commands = commands
            .into_iter()
            .filter(|_| self.configuration.takes_commands());
        commands.chain(self.birth_topic()).collect()
    }

    fn broker_came(&mut self, now: Duration, out: &mut Vec<Output>) {
        self.broker_is_up = true;
        self.say_all_anew(now, out);
    }

    fn broker_went(&mut self) {
        self.broker_is_up = false;
    }

    fn daemon_came(&mut self, out: &mut Vec<Output>) {
        self.daemon_is_up = true;
        out.push(Output::Ask(RequestBody::Runs {
            before: None,
            count: Some(1),
        }));
        self.wear_at = None;
    }

    fn daemon_went(&mut self, now: Duration, out: &mut Vec<Output>) {
        self.daemon_is_up = false;
        self.known.forget_state();
        self.say_changes(now, out);
    }

    fn update(&mut self, update: &Update, now: Duration, out: &mut Vec<Output>) {
        match update {
            Update::RunKept(run) => {
                self.last_run = Some((**run).clone());
                self.event(Saying::RunEnded, &documents::run(run), out);
            }
            Update::Runs { runs, .. } => self.last_run = runs.first().cloned(),
            Update::Health { components, .. } => self.wear.clone_from(components),
            Update::Done { .. } => return,
            Update::Failed(failure) => {
                let event = json!({"event_type": "refused", "reason": failure.reason, "text": failure.text});
                self.event(Saying::Refused, &event, out);
            }
            update => match self.known.take(update) {
                Change::Nothing => return,
                Change::Map => {
                    self.map_is_new = true;
                    // The picture has a time of its own.
                    return;
                }
                Change::Home => self.map_is_new = true,
                Change::Status => {
                    if self.known.wants_hello() {
                        out.push(Output::Hello);
                    }
                    self.watch_room(out);
                }
                _ => {}
            },
        }
        self.say_changes(now, out);
    }

    fn message(&mut self, message: &Incoming, now: Duration, out: &mut Vec<Output>) {
        if message.retained {
            // Nobody knows when that was said: a robot that starts because it restarted is none that people want.
            tracing::warn!(
                topic = message.topic,
                "a kept message is no command and is passed over"
            );
            return;
        }
        if !self.limiter.allows(now) {
            return;
        }
        if Some(&message.topic) == self.birth_topic().as_ref() {
            if message.payload == b"online" {
                self.say_all_anew(now, out);
            }
            return;
        }
        let Some(hearing) = self.topics.heard(&message.topic) else {
            return;
        };
        if !self.configuration.takes_commands() {
            tracing::warn!(
                topic = message.topic,
                "the broker lets everybody in, so commands are passed over: give user and password, or set commands = true"
            );
            return;
        }
        match commands::read(hearing, &message.payload) {
            Ok(order) => self.order(order, now, out),
            Err(error) => {
                let topic: String = message.topic.chars().take(80).collect();
                tracing::warn!(topic, %error, "a message is no command and is passed over");
            }
        }
    }

    fn wake(&mut self, now: Duration, out: &mut Vec<Output>) {
        if self.daemon_is_up && self.wear_at.is_none_or(|at| now >= at) {
            self.wear_at = Some(now + WEAR_EVERY);
            out.push(Output::Ask(RequestBody::Health));
        }
        self.say_changes(now, out);
        if self.map_is_due(now) {
            self.map_is_new = false;
            self.map_at = Some(now);
            if let Some(file) = picture::png(&self.known, &[]) {
                let message = Publish {
                    acknowledged: false,
                    ..self.state_message(Saying::Map, file)
                };
                out.push(Output::State(message));
            }
        }
    }
}

#[cfg(test)]
#[path = "core_tests.rs"]
mod tests;
