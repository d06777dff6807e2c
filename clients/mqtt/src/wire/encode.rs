//! Packets that go out.

use super::{PACKET_BYTES_MAX, Publish, Version};

/// How the client presents itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Login {
    pub(crate) version: Version,
    pub(crate) client_id: String,
    pub(crate) user: Option<String>,
    pub(crate) password: Option<String>,
    /// What the broker says for this client when it is gone without a word.
    pub(crate) will: Publish,
    /// Seconds without a packet after which the broker gives the client up.
    pub(crate) keep_alive_s: u16,
}

const CONNECT: u8 = 0x10;
const PUBLISH: u8 = 0x30;
const SUBSCRIBE: u8 = 0x82;
const PING: u8 = 0xc0;

/// Chapter 3.1. The session is a new one: what a broker kept for an earlier one would come late.
pub(crate) fn connect(login: &Login) -> Vec<u8> {
    let mut body = Vec::new();
    text(&mut body, "MQTT");
    body.push(match login.version {
        Version::V311 => 4,
        Version::V5 => 5,
    });
    let will = 0x04 | (u8::from(login.will.acknowledged) << 3) | (u8::from(login.will.retain) << 5);
    let user = u8::from(login.user.is_some()) << 7;
    let password = u8::from(login.password.is_some()) << 6;
    body.push(0x02 | will | user | password);
    body.extend_from_slice(&login.keep_alive_s.to_be_bytes());
    if login.version == Version::V5 {
        // The longest packet that the broker may send.
        body.push(5);
        body.push(0x27);
        body.extend_from_slice(&u32::try_from(PACKET_BYTES_MAX).unwrap_or(u32::MAX).to_be_bytes());
    }
    text(&mut body, &login.client_id);
    no_properties(&mut body, login.version);
    text(&mut body, &login.will.topic);
    bytes(&mut body, &login.will.payload);
    for word in [&login.user, &login.password].into_iter().flatten() {
        text(&mut body, word);
    }
    packet(CONNECT, &body)
}

/// Chapter 3.3. `id` is that of a message which the broker shall acknowledge.
pub(crate) fn publish(version: Version, message: &Publish, id: Option<u16>) -> Vec<u8> {
    let mut body = Vec::with_capacity(message.payload.len() + message.topic.len() + 8);
    text(&mut body, &message.topic);
    if let Some(id) = id {
        body.extend_from_slice(&id.to_be_bytes());
    }
    no_properties(&mut body, version);
    body.extend_from_slice(&message.payload);
    let quality = u8::from(id.is_some()) << 1;
    packet(PUBLISH | quality | u8::from(message.retain), &body)
}

/// Chapter 3.8, with quality 0: a command that could not be delivered at once is no command any more.
pub(crate) fn subscribe(version: Version, id: u16, topics: &[String]) -> Vec<u8> {
    let mut body = id.to_be_bytes().to_vec();
    no_properties(&mut body, version);
    for topic in topics {
        text(&mut body, topic);
        body.push(match version {
            Version::V311 => 0,
            // Nothing that was kept is sent.
            Version::V5 => 0x20,
        });
    }
    packet(SUBSCRIBE, &body)
}

pub(crate) fn ping() -> Vec<u8> {
    packet(PING, &[])
}

fn no_properties(body: &mut Vec<u8>, version: Version) {
    if version == Version::V5 {
        body.push(0);
    }
}

fn text(body: &mut Vec<u8>, text: &str) {
    bytes(body, text.as_bytes());
}

/// Length in two bytes, then the bytes; configuration sees to it that nothing is longer.
fn bytes(body: &mut Vec<u8>, bytes: &[u8]) {
    let length = u16::try_from(bytes.len()).unwrap_or(u16::MAX);
    body.extend_from_slice(&length.to_be_bytes());
    body.extend(bytes.iter().take(usize::from(length)));
}

fn packet(head: u8, body: &[u8]) -> Vec<u8> {
    let mut whole = Vec::with_capacity(body.len() + 5);
    whole.push(head);
    let mut left = body.len();
    loop {
        let low = u8::try_from(left & 0x7f).unwrap_or(0);
        left >>= 7;
        whole.push(if left > 0 { low | 0x80 } else { low });
        if left == 0 {
            break;
        }
    }
    whole.extend_from_slice(body);
    whole
}
