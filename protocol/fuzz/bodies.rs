//! What each fuzz target does with an input. The same bodies run in `cargo test` on mutated golden packets, see
//! `rvac-protocol/tests/mutations.rs`.
#![allow(dead_code, reason = "each target uses one of the bodies")]

use rvac_protocol::PacketBuffer;
use rvac_protocol::binary::{
    DRIVE, STATE, read_drive, read_state, write_drive, write_state, write_state_with_crc,
};
use rvac_protocol::crc::{Direction, packet_crc, to_hex};
use rvac_protocol::frame::PACKET_BYTES_MAX;
use rvac_protocol::message::{BinaryKinds, Capabilities, Description, Limits, MotorGaps, Name, ResetCause};
use rvac_protocol::session::{HostSession, RobotIdentity, RobotSession};
use rvac_protocol::text::{Form, ReportPacket, read_command, read_report, write_command, write_report};
use rvac_units::{AngularSpeed, Length, Speed, Tick};

/// A command that can be read can be written, and reads back as the same.
pub(crate) fn command_text(input: &[u8]) {
    let now = Tick(7);
    for form in [Form::Checked, Form::Hand { now }, Form::SealedHand { now }] {
        let Ok(command) = read_command(input, form) else {
            continue;
        };
        let mut buffer = PacketBuffer::new();
        assert_eq!(write_command(&command, &mut buffer), Ok(()));
        assert_eq!(read_command(buffer.as_bytes(), Form::Checked), Ok(command));
    }
}

/// A report that can be read can be written, and reads back as the same.
pub(crate) fn report_text(input: &[u8]) {
    let Ok(ReportPacket::Report(report)) = read_report(input) else {
        return;
    };
    let mut buffer = PacketBuffer::new();
    if write_report(&report, &mut buffer).is_err() {
        return;
    }
    // A name with characters that need no escape in text but are no name is written with `?`, so compare what is written.
    let Ok(ReportPacket::Report(again)) = read_report(buffer.as_bytes()) else {
        panic!("{report:?} does not read back");
    };
    let mut second = PacketBuffer::new();
    assert_eq!(write_report(&again, &mut second), Ok(()));
    assert_eq!(buffer.as_bytes(), second.as_bytes());
}

/// Binary bodies read back as the same.
pub(crate) fn binary(input: &[u8]) {
    if let Ok(drive) = read_drive(input) {
        let packet = write_drive(&drive).expect("what was read can be written");
        assert_eq!(packet.split_first(), Some((&DRIVE, input)));
    }
    if let Ok(state) = read_state(input) {
        let packet = write_state(&state);
        let (kind, body) = packet.split_first().expect("a packet has a kind");
        assert_eq!(*kind, STATE);
        assert_eq!(read_state(body), Ok(state));
        let mut buffer = PacketBuffer::new();
        assert_eq!(write_state_with_crc(&state, 1, &mut buffer), Ok(()));
        let inside = buffer
            .as_bytes()
            .split_last()
            .expect("a packet has a separator")
            .1;
        assert!(!inside.contains(&0x1E) && !inside.contains(&0x1F));
    }
}

/// Both ends take any bytes, as they come and with the CRC of a peer, and still understand the packet after the next
/// separator.
pub(crate) fn sessions(input: &[u8]) {
    let mut robot = RobotSession::new(identity(), Tick(0));
    let mut host = HostSession::new(BinaryKinds::ALL, Tick(0));
    let mut buffer = PacketBuffer::new();
    for (index, byte) in with_crcs(input).into_iter().enumerate() {
        let now = Tick(index as u32 * 3);
        let _event = robot.receive(byte, now);
        let _event = host.receive(byte, now);
        let _event = robot.poll(now);
        let _event = host.poll(now);
        while robot.next_packet(&mut buffer) {}
        while host.next_packet(&mut buffer) {}
    }
    let now = Tick(10_000_000);
    let _event = robot.receive(0x1F, now);
    let before = robot.counters();
    for byte in b"{\"c\":\"stop\"}\x1f" {
        let _event = robot.receive(*byte, now);
    }
    assert_eq!(robot.counters().accepted, before.accepted.wrapping_add(1));
}

/// The input as it is, and each of its pieces with a right CRC for either end.
fn with_crcs(input: &[u8]) -> Vec<u8> {
    let mut stream = input.to_vec();
    for piece in input
        .split(|byte| *byte == 0x1F)
        .filter(|piece| piece.len() < PACKET_BYTES_MAX)
    {
        for direction in [Direction::HostToRobot, Direction::RobotToHost] {
            stream.push(0x1F);
            stream.extend_from_slice(piece);
            stream.push(b'*');
            stream.extend(to_hex(packet_crc(direction, 0, piece)));
        }
    }
    stream
}

fn identity() -> RobotIdentity {
    RobotIdentity {
        device: Name::new(),
        firmware: Name::new(),
        boot_count: 0,
        reset_cause: ResetCause::Unknown,
        session_seed: 0,
        binary: BinaryKinds::ALL,
        description: Description {
            capabilities: Capabilities::default(),
            limits: Limits {
                speed_max: Speed(0),
                turn_max: AngularSpeed(0),
                track: Length(0),
                count_nm: 0,
                radius: Length(0),
                swath: Length(0),
            },
            motors: MotorGaps::default(),
        },
    }
}
