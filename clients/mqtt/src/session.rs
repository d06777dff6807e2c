//! A client's session with a broker: bytes and the time go in, bytes and news come out.
//!
//! Of state the newest wins: a message that waits under a topic is replaced by the next one of it. Events wait in a queue with an end.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use crate::wire::{self, BadPacket, Decoder, Incoming, Login, Packet, Publish};

/// Events that wait for the broker; older ones go.
const EVENTS_MAX: usize = 32;
/// Messages on their way without the broker's word that it has them, unless it allows fewer.
const UNACKNOWLEDGED_MAX: usize = 16;
/// The broker answers a ping or a connection within this time, or is as good as gone.
const PATIENCE: Duration = Duration::from_secs(8);

/// What came of bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum SessionNews {
    /// The broker has let us in.
    Open,
    /// A message.
    Message(Incoming),
}

/// Why a session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum SessionEnd {
    /// The broker does not want us.
    #[error("the broker refuses the connection (code {0}: {words})", words = refusal(*.0))]
    Refused(u8),
    /// It does not let us follow our own topics.
    #[error("the broker refuses the subscriptions: let this client read and write its own topics")]
    NotSubscribed,
    /// It said goodbye.
    #[error("the broker has ended the connection")]
    Disconnected,
    /// It says nothing.
    #[error("the broker is silent")]
    Silent,
    /// It sent what it may not.
    #[error(transparent)]
    Bad(#[from] BadPacket),
}

/// Codes of chapter 3.2.2.3 of 3.1.1 and 3.2.2.2 of 5.
fn refusal(code: u8) -> &'static str {
    match code {
        1 | 0x84 => "it does not speak this version of MQTT; see `version`",
        2 | 0x85 => "it does not like the client's id; see `id`",
        3 | 0x88 => "it is not available",
        4 | 0x86 => "wrong user or password",
        5 | 0x87 => "this user may not connect",
        _ => "for another reason",
    }
}

/// One connection.
#[derive(Debug)]
pub(crate) struct Session {
    login: Login,
    topics: Vec<String>,
    decoder: Decoder,
    open: bool,
    states: BTreeMap<String, Publish>,
    events: VecDeque<Publish>,
    unacknowledged: Vec<u16>,
    unacknowledged_max: usize,
    packet_bytes_max: usize,
    keep_alive: Duration,
    last_id: u16,
    sent_at: Duration,
    /// Since when an answer is awaited.
    waits_since: Option<Duration>,
}

impl Session {
    /// A session that follows these topics, and the bytes that begin it. Times are those of any clock that does not jump.
    pub(crate) fn begin(login: Login, topics: Vec<String>, now: Duration) -> (Self, Vec<u8>) {
        let bytes = wire::connect(&login);
        let session = Self {
            decoder: Decoder::new(login.version),
            topics,
            open: false,
            states: BTreeMap::new(),
            events: VecDeque::new(),
            unacknowledged: Vec::new(),
            unacknowledged_max: UNACKNOWLEDGED_MAX,
            packet_bytes_max: usize::MAX,
            keep_alive: Duration::from_secs(login.keep_alive_s.into()),
            last_id: 0,
            sent_at: now,
            waits_since: Some(now),
            login,
        };
        (session, bytes)
    }

    /// Takes what the broker has sent.
    pub(crate) fn receive(
        &mut self,
        bytes: &[u8],
        now: Duration,
        news: &mut Vec<SessionNews>,
    ) -> Result<(), SessionEnd> {
        let mut packets = Vec::new();
        self.decoder.take(bytes, |packet| packets.push(packet))?;
        for packet in packets {
            match packet {
                Packet::Accepted(limits) => {
                    let allowed = limits.receive_max.map_or(usize::MAX, usize::from);
                    self.unacknowledged_max = UNACKNOWLEDGED_MAX.min(allowed);
                    self.packet_bytes_max = limits
                        .packet_bytes_max
                        .and_then(|bytes| usize::try_from(bytes).ok())
                        .unwrap_or(usize::MAX);
                    if let Some(keep_alive_s) = limits.keep_alive_s {
                        self.keep_alive = Duration::from_secs(keep_alive_s.max(1).into());
                    }
                    self.open = true;
                    self.waits_since = None;
                    news.push(SessionNews::Open);
                }
                Packet::Refused(code) => return Err(SessionEnd::Refused(code)),
                Packet::Subscribed(false) => return Err(SessionEnd::NotSubscribed),
                Packet::Disconnected => return Err(SessionEnd::Disconnected),
                Packet::Message(message) => news.push(SessionNews::Message(message)),
                Packet::Acknowledged(id) => self.unacknowledged.retain(|waiting| *waiting != id),
                Packet::Subscribed(true) | Packet::Pong => {}
            }
            if self.open {
                self.waits_since = (!self.unacknowledged.is_empty()).then_some(now);
            }
        }
        Ok(())
    }

    /// A state, in place of one under the same topic that waits.
    pub(crate) fn set(&mut self, message: Publish) {
        self.states.insert(message.topic.clone(), message);
    }

    /// An event, after those that wait.
    pub(crate) fn add(&mut self, message: Publish) {
        if self.events.len() == EVENTS_MAX {
            self.events.pop_front();
        }
        self.events.push_back(message);
    }

    /// The bytes that begin it on the broker's side: subscriptions. Once, when it is open.
    pub(crate) fn subscriptions(&mut self) -> Vec<u8> {
        let id = self.next_id();
        wire::subscribe(self.login.version, id, &self.topics)
    }

    /// Appends what is to be sent now; says when to ask again at the latest.
    pub(crate) fn poll(&mut self, now: Duration, out: &mut Vec<u8>) -> Result<Duration, SessionEnd> {
        if self
            .waits_since
            .is_some_and(|since| now.saturating_sub(since) >= PATIENCE)
        {
            return Err(SessionEnd::Silent);
        }
        if self.open {
            self.send_waiting(now, out);
        }
        // Half of the time, so that the ping arrives in time.
        let ping_at = self.sent_at + self.keep_alive / 2;
        if self.open && now >= ping_at && self.waits_since.is_none() {
            out.extend_from_slice(&wire::ping());
            self.waits_since = Some(now);
        }
        if !out.is_empty() {
            self.sent_at = now;
        }
        Ok(match self.waits_since {
            Some(since) => since + PATIENCE,
            None => self.sent_at + self.keep_alive / 2,
        })
    }

    fn send_waiting(&mut self, now: Duration, out: &mut Vec<u8>) {
        while self.unacknowledged.len() < self.unacknowledged_max {
            let next = self.events.pop_front();
            let Some(message) = next.or_else(|| self.states.pop_first().map(|(_, message)| message)) else {
                return;
            };
            let id = message.acknowledged.then(|| self.next_id());
            let bytes = wire::publish(self.login.version, &message, id);
            if bytes.len() > self.packet_bytes_max {
                tracing::warn!(
                    topic = message.topic,
                    bytes = bytes.len(),
                    "too long for the broker"
                );
                continue;
            }
            out.extend_from_slice(&bytes);
            if let Some(id) = id {
                self.unacknowledged.push(id);
                self.waits_since.get_or_insert(now);
            }
        }
    }

    fn next_id(&mut self) -> u16 {
        loop {
            self.last_id = self.last_id.wrapping_add(1).max(1);
            if !self.unacknowledged.contains(&self.last_id) {
                return self.last_id;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{EVENTS_MAX, Session, SessionEnd, SessionNews};
    use crate::wire::{Login, Publish, Version};

    fn message(topic: &str, payload: &str, acknowledged: bool) -> Publish {
        Publish {
            topic: topic.to_owned(),
            payload: payload.as_bytes().to_vec(),
            retain: acknowledged,
            acknowledged,
        }
    }

    fn open(version: Version) -> Session {
        let login = Login {
            version,
            client_id: "c".to_owned(),
            user: Some("u".to_owned()),
            password: None,
            will: message("w", "gone", true),
            keep_alive_s: 60,
        };
        let (mut session, bytes) = Session::begin(login, vec!["in".to_owned()], Duration::ZERO);
        assert_eq!(bytes.first(), Some(&0x10));
        let mut news = Vec::new();
        let accepted: &[u8] = match version {
            Version::V311 => &[0x20, 2, 0, 0],
            Version::V5 => &[0x20, 6, 0, 0, 3, 0x21, 0, 2],
        };
        session
            .receive(accepted, Duration::ZERO, &mut news)
            .expect("let in");
        assert_eq!(news, [SessionNews::Open]);
        session
    }

    #[test]
    fn of_states_the_newest_is_sent_and_events_end_somewhere() {
        let mut session = open(Version::V311);
        session.set(message("s", "old", false));
        session.set(message("s", "new", false));
        for number in 0..EVENTS_MAX + 3 {
            session.add(message("e", &number.to_string(), false));
        }
        let mut out = Vec::new();
        session.poll(Duration::ZERO, &mut out).expect("open");
        let text = String::from_utf8_lossy(&out).into_owned();
        assert!(text.contains("new") && !text.contains("old"), "{text}");
        assert_eq!(
            text.matches('e').count(),
            EVENTS_MAX + 1,
            "each event, and the new state"
        );
    }

    #[test]
    fn no_more_messages_are_on_their_way_than_the_broker_allows() {
        let mut session = open(Version::V5);
        for topic in ["a", "b", "c"] {
            session.set(message(topic, "1", true));
        }
        let mut out = Vec::new();
        session.poll(Duration::ZERO, &mut out).expect("open");
        assert_eq!(out.iter().filter(|byte| **byte == 0x33).count(), 2);
        out.clear();
        session
            .receive(&[0x40, 2, 0, 1], Duration::ZERO, &mut Vec::new())
            .expect("acknowledged");
        session.poll(Duration::ZERO, &mut out).expect("open");
        assert!(out.contains(&b'c'));
    }

    #[test]
    fn a_silent_broker_is_given_up() {
        let mut session = open(Version::V311);
        let mut out = Vec::new();
        let ping_at = session.poll(Duration::ZERO, &mut out).expect("open");
        assert_eq!(ping_at, Duration::from_secs(30));
        session.poll(ping_at, &mut out).expect("open");
        assert_eq!(out, [0xc0, 0]);
        let end = session.poll(ping_at + Duration::from_secs(8), &mut out);
        assert_eq!(end, Err(SessionEnd::Silent));
    }
}
