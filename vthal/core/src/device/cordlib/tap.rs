//! A view of the wire for people and recordings: each packet as text, both directions, binary ones as their text twin.

use rvac_protocol::PacketBuffer;
use rvac_protocol::binary;
use rvac_protocol::crc;
use rvac_protocol::frame::{Framed, Framer};
use rvac_protocol::message::{Command, Report};
use rvac_protocol::text;

use crate::Direction;

/// Text for packets that cannot be shown as they are.
const UNREADABLE: &str = "(unreadable)";

/// One direction of the wire.
#[derive(Debug)]
struct Line {
    framer: Framer,
    session: u16,
}

impl Line {
    fn new(direction: crc::Direction) -> Self {
        Self {
            framer: Framer::new(direction),
            session: 0,
        }
    }

    fn read(&mut self, session: u16, bytes: &[u8], mut show: impl FnMut(Framed<'_>)) {
        for byte in bytes {
            // Between packets only: the framer begins anew with the new number.
            if self.session != session && !self.framer.is_inside_packet() {
                self.session = session;
                self.framer.set_session(session);
            }
            if let Some(framed) = self.framer.push(*byte) {
                show(framed);
            }
        }
    }
}

/// Both directions.
#[derive(Debug)]
pub(super) struct Tap {
    from_robot: Line,
    to_robot: Line,
}

impl Default for Tap {
    fn default() -> Self {
        Self {
            from_robot: Line::new(crc::Direction::RobotToHost),
            to_robot: Line::new(crc::Direction::HostToRobot),
        }
    }
}

impl Tap {
    /// Appends the packets that `bytes` complete.
    pub(super) fn take_received(
        &mut self,
        session: u16,
        bytes: &[u8],
        packets: &mut Vec<(Direction, String)>,
    ) {
        self.from_robot.read(session, bytes, |framed| {
            packets.push((Direction::FromRobot, shown(framed, state_twin)));
        });
    }

    /// Appends the packets that `bytes` complete.
    pub(super) fn take_sent(&mut self, session: u16, bytes: &[u8], packets: &mut Vec<(Direction, String)>) {
        self.to_robot.read(session, bytes, |framed| {
            packets.push((Direction::ToRobot, shown(framed, drive_twin)));
        });
    }
}

fn shown(framed: Framed<'_>, twin: impl Fn(u8, &[u8]) -> Option<PacketBuffer>) -> String {
    match framed {
        Framed::Unchecked(text) | Framed::Checked(text) | Framed::BadCrc { text, .. } => {
            String::from_utf8_lossy(text).into_owned()
        }
        Framed::Binary { kind, body } => twin(kind, body).map_or_else(
            || UNREADABLE.to_owned(),
            |buffer| String::from_utf8_lossy(buffer.as_bytes()).into_owned(),
        ),
        Framed::BinaryBadCrc | Framed::Poisoned(_) => UNREADABLE.to_owned(),
    }
}

fn state_twin(kind: u8, body: &[u8]) -> Option<PacketBuffer> {
    let state = (kind == binary::STATE).then(|| binary::read_state(body).ok())??;
    let mut buffer = PacketBuffer::new();
    text::write_report(&Report::State(state), &mut buffer).ok()?;
    Some(buffer)
}

fn drive_twin(kind: u8, body: &[u8]) -> Option<PacketBuffer> {
    let drive = (kind == binary::DRIVE).then(|| binary::read_drive(body).ok())??;
    let mut buffer = PacketBuffer::new();
    text::write_command(&Command::Drive(drive), &mut buffer).ok()?;
    Some(buffer)
}

#[cfg(test)]
mod tests {
    use rvac_protocol::PacketBuffer;
    use rvac_protocol::message::{Command, Inhibit, Sequence};
    use rvac_protocol::text::write_command_with_crc;

    use super::Tap;
    use crate::Direction;

    #[test]
    fn text_packets_are_shown_without_their_seal() {
        let mut buffer = PacketBuffer::new();
        let clear = Command::Clear {
            sequence: Sequence(7),
            inhibit: Inhibit::WheelStall,
        };
        write_command_with_crc(&clear, 5, &mut buffer).expect("fits");
        let mut packets = Vec::new();
        let mut tap = Tap::default();
        let (first, rest) = buffer.as_bytes().split_at(9);
        tap.take_sent(5, first, &mut packets);
        assert!(packets.is_empty());
        tap.take_sent(5, rest, &mut packets);
        let [(Direction::ToRobot, text)] = packets.as_slice() else {
            panic!("one packet, not {packets:?}")
        };
        assert!(
            text.starts_with('{') && text.ends_with('}') && text.contains("wheel-stall"),
            "{text}"
        );
    }
}
