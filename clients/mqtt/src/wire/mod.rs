//! The bytes of MQTT 3.1.1 and 5, as far as a client needs them that speaks with quality 0 and 1 and subscribes with quality 0.
//!
//! Chapters are those of the standards of OASIS, *MQTT Version 3.1.1* and *MQTT Version 5.0*. What a broker sends is checked once, here.

mod decoder;
mod encode;
mod properties;

pub(crate) use decoder::{BadPacket, Decoder, Packet};
pub(crate) use encode::{Login, connect, ping, publish, subscribe};

/// Version of the protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
pub(crate) enum Version {
    /// MQTT 3.1.1.
    #[serde(rename = "3.1.1")]
    V311,
    /// MQTT 5.
    #[serde(rename = "5")]
    V5,
}

/// Longest packet that is taken from a broker; commands have some hundred bytes. A longer one is passed over as it comes.
pub(crate) const PACKET_BYTES_MAX: usize = 64 << 10;

/// A message that goes out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Publish {
    pub(crate) topic: String,
    pub(crate) payload: Vec<u8>,
    /// The broker keeps it for those who come later.
    pub(crate) retain: bool,
    /// The broker says that it has it; otherwise it may get lost.
    pub(crate) acknowledged: bool,
}

/// A message that came in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Incoming {
    pub(crate) topic: String,
    pub(crate) payload: Vec<u8>,
    /// The broker had kept it since before the subscription.
    pub(crate) retained: bool,
}
