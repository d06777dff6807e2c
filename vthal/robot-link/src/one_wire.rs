//! One wire, or one pair, for both directions: when the host may speak, and which bytes are its own.

use std::collections::VecDeque;

use rvac_protocol::frame::SEPARATOR;

/// A robot that says two packets in a row begins the second within this time.
const QUIET_US: u64 = 400;
/// Until then after a packet the host may begin. The robot sends its state 20 to 50 times a second, so its next one is far away.
const SLOT_US: u64 = 4_000;
/// A wire on which nothing passes for so long belongs to whoever takes it.
const SILENCE_US: u64 = 60_000;
/// An echo that has not come by then does not come any more: something else was on the wire.
const ECHO_US: u64 = 50_000;
/// Longest time that the host takes the wire, so that the robot's next packet finds it free.
const TURN_MS: u32 = 6;
/// Start, eight, stop.
const BITS_OF_A_BYTE: u32 = 10;

/// The host's side of a shared wire.
#[derive(Clone, Debug)]
pub struct OneWire {
    /// Bytes of ours that the wire brings back, in order; empty where the receiver is off while the driver is on.
    expected: VecDeque<u8>,
    hears_itself: bool,
    turn_max: usize,
    sent_us: u64,
    heard_us: u64,
    ended_packet: bool,
    collisions: u32,
}

impl OneWire {
    /// A wire that is quiet. With one wire the host hears itself; behind an RS-485 driver it does not.
    #[must_use]
    pub const fn new(hears_itself: bool, baud: u32) -> Self {
        Self {
            expected: VecDeque::new(),
            hears_itself,
            turn_max: (baud / BITS_OF_A_BYTE * TURN_MS / 1_000) as usize,
            sent_us: 0,
            heard_us: 0,
            ended_packet: true,
            collisions: 0,
        }
    }

    /// How many of the waiting bytes may be sent now.
    #[must_use]
    pub fn may_send(&self, now_us: u64, waiting: usize) -> usize {
        let since_us = now_us.saturating_sub(self.heard_us);
        let is_slot = self.ended_packet && (QUIET_US..=SLOT_US).contains(&since_us);
        let is_ours = self.expected.is_empty() && (is_slot || since_us >= SILENCE_US);
        if is_ours { waiting.min(self.turn_max) } else { 0 }
    }

    /// When to ask again, if nothing comes before.
    #[must_use]
    pub const fn ask_again_us(&self, now_us: u64) -> u64 {
        let is_fresh = self.ended_packet && now_us < self.heard_us + QUIET_US;
        self.heard_us + if is_fresh { QUIET_US } else { SILENCE_US }
    }

    /// These bytes are on their way.
    pub fn sent(&mut self, now_us: u64, bytes: &[u8]) {
        self.sent_us = now_us;
        self.heard_us = now_us;
        self.ended_packet = false;
        if self.hears_itself {
            self.expected.extend(bytes);
        }
    }

    /// Takes what the wire brought; leaves what the robot has said.
    pub fn receive(&mut self, now_us: u64, bytes: &mut Vec<u8>) {
        if !self.expected.is_empty() && now_us.saturating_sub(self.sent_us) > ECHO_US {
            self.expected.clear();
            self.collisions += 1;
        }
        let (expected, collisions) = (&mut self.expected, &mut self.collisions);
        bytes.retain(|byte| match expected.pop_front() {
            None => true,
            Some(own) if own == *byte => false,
            Some(_) => {
                // Two spoke at once: neither was understood, and the CRC of the robot's packet says so.
                expected.clear();
                *collisions += 1;
                true
            }
        });
        if let Some(last) = bytes.last() {
            self.heard_us = now_us;
            self.ended_packet = *last == SEPARATOR;
        }
    }

    /// Times that both ends spoke at once.
    #[must_use]
    pub const fn collisions(&self) -> u32 {
        self.collisions
    }
}

#[cfg(test)]
mod tests {
    use super::{OneWire, QUIET_US, SEPARATOR, SILENCE_US, SLOT_US};

    const BAUD: u32 = 230_400;
    const TURN_MAX: usize = 138;

    fn hear(wire: &mut OneWire, now_us: u64, bytes: &[u8]) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        wire.receive(now_us, &mut bytes);
        bytes
    }

    #[test]
    fn the_host_speaks_after_a_packet_or_into_silence() {
        let mut wire = OneWire::new(false, BAUD);
        assert_eq!(wire.may_send(SILENCE_US, 10), 10, "nobody there");
        let now_us = 1_000_000;
        hear(&mut wire, now_us, b"{\"r\"");
        assert_eq!(wire.may_send(now_us + 100, 10), 0, "in the middle of a packet");
        hear(&mut wire, now_us + 200, &[b'}', SEPARATOR]);
        assert_eq!(wire.may_send(now_us + 300, 1000), 0, "another packet may follow");
        assert_eq!(wire.ask_again_us(now_us + 300), now_us + 200 + QUIET_US);
        assert_eq!(wire.may_send(now_us + 200 + QUIET_US, 1000), TURN_MAX);
        assert_eq!(
            wire.may_send(now_us + 201 + SLOT_US, 10),
            0,
            "the robot's turn is near"
        );
        assert_eq!(wire.may_send(now_us + 200 + SILENCE_US, 10), 10);
        assert_eq!(
            wire.ask_again_us(now_us + 201 + SLOT_US),
            now_us + 200 + SILENCE_US
        );
    }

    #[test]
    fn its_own_bytes_are_no_words_of_the_robot() {
        let mut wire = OneWire::new(true, BAUD);
        wire.sent(100, b"ab");
        assert_eq!(wire.may_send(100_000, 5), 0, "the echo is still on its way");
        assert_eq!(hear(&mut wire, 200, b"a"), b"");
        assert_eq!(hear(&mut wire, 300, b"bcd"), b"cd");
        assert_eq!(wire.collisions(), 0);
    }

    #[test]
    fn a_collision_is_counted_and_the_wire_goes_on() {
        let mut wire = OneWire::new(true, BAUD);
        wire.sent(100, b"abc");
        assert_eq!(hear(&mut wire, 200, b"aXc"), b"Xc");
        assert_eq!(wire.collisions(), 1);
        wire.sent(1_000_000, b"abc");
        assert_eq!(
            hear(&mut wire, 2_000_000, b"abc"),
            b"abc",
            "an echo that late is none"
        );
        assert_eq!(wire.collisions(), 2);
        assert_eq!(wire.may_send(2_060_000, 3), 3);
    }
}
