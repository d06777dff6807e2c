//! Sends one packet at a time through the board's transmit queue, however slowly that drains. The next packet is written
//! only when the last byte of this one has been taken, so that packets never mix and telemetry is fresh when it leaves.

use rvac_protocol::PacketBuffer;

use crate::board::Link;

/// The packet that is being sent.
#[derive(Clone, Debug, Default)]
pub(crate) struct PacketSender {
    packet: PacketBuffer,
    sent: usize,
}

impl PacketSender {
    /// Where to write the next packet, if the last one is gone.
    pub(crate) fn next(&mut self) -> Option<&mut PacketBuffer> {
        if self.sent < self.packet.as_bytes().len() {
            return None;
        }
        self.sent = 0;
        self.packet.clear();
        Some(&mut self.packet)
    }

    /// Hands bytes to the board; returns how many it took.
    pub(crate) fn serve<L: Link>(&mut self, link: &mut L) -> usize {
        let waiting = self.packet.as_bytes().get(self.sent..).unwrap_or_default();
        if waiting.is_empty() {
            return 0;
        }
        let taken = link.transmit(waiting).min(waiting.len());
        self.sent = self.sent.saturating_add(taken);
        taken
    }
}
