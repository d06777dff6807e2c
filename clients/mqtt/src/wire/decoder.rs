//! Packets that come in, however they are cut.

use super::properties::{self, Limits};
use super::{Incoming, PACKET_BYTES_MAX, Version};

/// What a broker sends to such a client.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Packet {
    /// The client is let in.
    Accepted(Limits),
    /// It is not, for this reason of chapter 3.2.2.
    Refused(u8),
    /// A message.
    Message(Incoming),
    /// The broker has the message of this number; whether it took it is its own affair.
    Acknowledged(u16),
    /// The answer to subscriptions: whether all were granted.
    Subscribed(bool),
    /// The answer to a ping.
    Pong,
    /// The broker ends the connection.
    Disconnected,
}

/// The broker sent what no broker may.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum BadPacket {
    /// The length of a packet is none.
    #[error("a packet of the broker has no length")]
    Length,
    /// A packet ends before its content.
    #[error("a packet of the broker with the first byte {0:#04x} is too short or malformed")]
    Content(u8),
    /// Such a packet goes to brokers only, or to other clients.
    #[error("the broker sent a packet with the first byte {0:#04x}, which clients do not get")]
    Kind(u8),
}

/// Cuts bytes into packets.
#[derive(Debug)]
pub(crate) struct Decoder {
    version: Version,
    received: Vec<u8>,
    /// Bytes of an overlong packet that are still to come.
    to_skip: usize,
}

impl Decoder {
    pub(crate) fn new(version: Version) -> Self {
        Self {
            version,
            received: Vec::new(),
            to_skip: 0,
        }
    }

    /// Takes bytes, and gives to `each` the packets that are whole by now.
    pub(crate) fn take(&mut self, mut bytes: &[u8], mut each: impl FnMut(Packet)) -> Result<(), BadPacket> {
        let skipped = self.to_skip.min(bytes.len());
        self.to_skip -= skipped;
        bytes = bytes.get(skipped..).unwrap_or_default();
        self.received.extend_from_slice(bytes);
        let mut at = 0;
        while let Some((head, length, start)) = self.head(at)? {
            let present = self.received.len() - start;
            if length > PACKET_BYTES_MAX {
                self.to_skip = length.saturating_sub(present);
                at = start + length.min(present);
                continue;
            }
            let Some(body) = self.received.get(start..start + length) else {
                break;
            };
            at = start + length;
            if let Some(packet) = read(self.version, head, body)? {
                each(packet);
            }
        }
        self.received.drain(..at);
        Ok(())
    }

    /// First byte, length of the content, and where that begins.
    fn head(&self, at: usize) -> Result<Option<(u8, usize, usize)>, BadPacket> {
        let Some((&head, rest)) = self.received.get(at..).and_then(<[u8]>::split_first) else {
            return Ok(None);
        };
        match properties::variable(rest) {
            Some((length, content)) => Ok(Some((head, length, self.received.len() - content.len()))),
            None if rest.len() < 4 => Ok(None),
            None => Err(BadPacket::Length),
        }
    }
}

fn read(version: Version, head: u8, body: &[u8]) -> Result<Option<Packet>, BadPacket> {
    let is_v5 = version == Version::V5;
    let whole = match head >> 4 {
        2 => connack(is_v5, body).map(Some),
        3 => message(is_v5, head, body),
        4 => number(body).map(|id| Some(Packet::Acknowledged(id))),
        9 => suback(is_v5, body).map(Some),
        13 => Some(Some(Packet::Pong)),
        14 => Some(Some(Packet::Disconnected)),
        _ => return Err(BadPacket::Kind(head)),
    };
    whole.ok_or(BadPacket::Content(head))
}

fn connack(is_v5: bool, body: &[u8]) -> Option<Packet> {
    let (&[_, reason], rest) = body.split_first_chunk::<2>()?;
    if reason != 0 {
        return Some(Packet::Refused(reason));
    }
    let limits = if is_v5 {
        properties::limits(properties::split(rest)?.0)?
    } else {
        Limits::default()
    };
    Some(Packet::Accepted(limits))
}

/// `Some(None)` for a message that says nothing to us: its topic is no text, or it came with a quality that was not asked for.
fn message(is_v5: bool, head: u8, body: &[u8]) -> Option<Option<Packet>> {
    let (length, rest) = body.split_first_chunk::<2>()?;
    let (topic, mut rest) = rest.split_at_checked(usize::from(u16::from_be_bytes(*length)))?;
    let quality = (head >> 1) & 3;
    if quality > 0 {
        rest = rest.get(2..)?;
    }
    if is_v5 {
        rest = properties::split(rest)?.1;
    }
    let Ok(topic) = std::str::from_utf8(topic) else {
        return Some(None);
    };
    Some((quality == 0).then(|| {
        Packet::Message(Incoming {
            topic: topic.to_owned(),
            payload: rest.to_vec(),
            retained: head & 1 == 1,
        })
    }))
}

fn suback(is_v5: bool, body: &[u8]) -> Option<Packet> {
    let mut rest = body.get(2..)?;
    if is_v5 {
        rest = properties::split(rest)?.1;
    }
    Some(Packet::Subscribed(
        !rest.is_empty() && rest.iter().all(|granted| *granted < 0x80),
    ))
}

fn number(body: &[u8]) -> Option<u16> {
    body.split_first_chunk::<2>()
        .map(|(id, _)| u16::from_be_bytes(*id))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{BadPacket, Decoder, Packet};
    use crate::wire::{Incoming, PACKET_BYTES_MAX, Publish, Version, publish};

    fn all(version: Version, pieces: &[&[u8]]) -> Result<Vec<Packet>, BadPacket> {
        let mut decoder = Decoder::new(version);
        let mut packets = Vec::new();
        for piece in pieces {
            decoder.take(piece, |packet| packets.push(packet))?;
        }
        Ok(packets)
    }

    #[test]
    fn packets_of_a_broker_are_read_as_the_standard_writes_them() {
        // Accepted, with a receive maximum of 20 and a topic alias maximum of 10, as mosquitto 2 says it.
        let accepted = [0x20, 9, 0, 0, 6, 0x22, 0, 10, 0x21, 0, 20];
        let packets = all(Version::V5, &[&accepted]).expect("well-formed");
        let Some(Packet::Accepted(limits)) = packets.first() else {
            panic!("{packets:?}");
        };
        assert_eq!(limits.receive_max, Some(20));
        let refused = all(Version::V311, &[&[0x20, 2, 0, 5]]);
        assert_eq!(refused, Ok(vec![Packet::Refused(5)]));
        let answers = all(
            Version::V311,
            &[&[0x90, 3, 0, 1, 0, 0x40, 2, 1, 2, 0xd0, 0, 0x90, 3, 0, 1, 0x80]],
        );
        let expected = [
            Packet::Subscribed(true),
            Packet::Acknowledged(258),
            Packet::Pong,
            Packet::Subscribed(false),
        ];
        assert_eq!(answers, Ok(expected.to_vec()));
        assert_eq!(all(Version::V311, &[&[0x10, 0]]), Err(BadPacket::Kind(0x10)));
        assert_eq!(
            all(Version::V311, &[&[0x30, 0xff, 0xff, 0xff, 0xff, 1]]),
            Err(BadPacket::Length)
        );
        assert_eq!(
            all(Version::V5, &[&[0x30, 2, 0, 9]]),
            Err(BadPacket::Content(0x30))
        );
    }

    #[test]
    fn an_overlong_packet_is_passed_over_as_it_comes() {
        let long = Publish {
            topic: "t".to_owned(),
            payload: vec![7; 3 * PACKET_BYTES_MAX],
            retain: false,
            acknowledged: false,
        };
        let short = Publish {
            payload: b"on".to_vec(),
            ..long.clone()
        };
        let bytes = [
            publish(Version::V311, &long, None),
            publish(Version::V311, &short, None),
        ]
        .concat();
        let mut decoder = Decoder::new(Version::V311);
        let mut packets = Vec::new();
        for piece in bytes.chunks(1000) {
            decoder
                .take(piece, |packet| packets.push(packet))
                .expect("well-formed");
            assert!(decoder.received.len() <= 1000, "nothing of it is kept");
        }
        let [Packet::Message(message)] = packets.as_slice() else {
            panic!("{packets:?}");
        };
        assert_eq!(message.payload, b"on");
    }

    proptest! {
        #[test]
        fn no_bytes_of_a_broker_make_it_fail_or_grow(pieces in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..300), 0..20), five in any::<bool>()) {
            let mut decoder = Decoder::new(if five { Version::V5 } else { Version::V311 });
            for piece in &pieces {
                if decoder.take(piece, |_| {}).is_err() {
                    break;
                }
                prop_assert!(decoder.received.len() <= PACKET_BYTES_MAX + 5 + 300);
            }
        }

        #[test]
        fn what_we_write_is_read_again_however_it_is_cut(payload in prop::collection::vec(any::<u8>(), 0..400), cut in 0_usize..410, five in any::<bool>()) {
            let version = if five { Version::V5 } else { Version::V311 };
            let message = Publish { topic: "a/b".to_owned(), payload: payload.clone(), retain: true, acknowledged: false };
            let bytes = publish(version, &message, None);
            let (one, other) = bytes.split_at(cut.min(bytes.len()));
            let packets = all(version, &[one, other]).expect("well-formed");
            let expected = Incoming { topic: "a/b".to_owned(), payload, retained: true };
            prop_assert_eq!(packets, vec![Packet::Message(expected)]);
        }
    }
}
