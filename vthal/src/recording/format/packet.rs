//! The recorded form of a packet of the wire.

use schemars::JsonSchema;
use serde::Serialize;
use vthal_core::Direction;

/// A packet of the wire.
#[derive(Debug, Serialize, JsonSchema)]
pub struct SentPacket<'packet> {
    direction: char,
    text: &'packet str,
}

impl<'packet> SentPacket<'packet> {
    /// A packet as text.
    #[must_use]
    pub fn new(direction: Direction, text: &'packet str) -> Self {
        Self {
            direction: direction.symbol(),
            text,
        }
    }
}
