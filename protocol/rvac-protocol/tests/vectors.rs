//! The golden vectors in `protocol/vectors`. If one is red, revert the change that made it red: packets that robots in the
//! field send and understand do not change their spelling. New packets get new vectors.

mod meaning;

use std::collections::BTreeSet;

use rvac_protocol::PacketBuffer;
use rvac_protocol::binary;
use rvac_protocol::crc::{Direction, packet_crc, to_hex};
use rvac_protocol::frame::{Framed, Framer, PACKET_BYTES_MAX, Poison};
use rvac_protocol::message::{Command, CommandName, Info, Refusal, Report, State};
use rvac_protocol::text::{
    Form, InfoPart, ReportPacket, read_command, read_report, write_command_with_crc, write_report_with_crc,
};
use rvac_units::Tick;
use serde_json::{Value, json};

/// The vectors of one file.
fn vectors(file: &str) -> Vec<Value> {
    let path = format!("{}/../vectors/{file}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let mut file: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}"));
    match file["vectors"].take() {
        Value::Array(vectors) if !vectors.is_empty() => vectors,
        _ => panic!("{path}: no vectors"),
    }
}

fn text<'v>(vector: &'v Value, key: &str) -> &'v str {
    vector[key]
        .as_str()
        .unwrap_or_else(|| panic!("no {key} in {vector}"))
}

fn session(vector: &Value) -> u16 {
    vector["session"]
        .as_u64()
        .and_then(|session| u16::try_from(session).ok())
        .expect("a session number")
}

fn from_hex(digits: &str) -> Vec<u8> {
    (0..digits.len())
        .step_by(2)
        .map(|at| u8::from_str_radix(&digits[at..at + 2], 16).expect("hexadecimal digits"))
        .collect()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The bytes of a packet of `vector`, its separator included.
fn line(vector: &Value) -> Vec<u8> {
    [text(vector, "line").as_bytes(), b"\x1f"].concat()
}

/// Texts of the packets with a CRC on the line.
fn checked_texts(line: &[u8], direction: Direction, session: u16) -> Vec<Vec<u8>> {
    let mut framer = Framer::new(direction);
    framer.set_session(session);
    let mut texts = Vec::new();
    for byte in line {
        match framer.push(*byte) {
            Some(Framed::Checked(text)) => texts.push(text.to_vec()),
            Some(other) => panic!("{other:?} in {}", line.escape_ascii()),
            None => {}
        }
    }
    texts
}

fn binary_body(line: &[u8], direction: Direction, session: u16) -> (u8, Vec<u8>) {
    let mut framer = Framer::new(direction);
    framer.set_session(session);
    let mut packets = Vec::new();
    for byte in line.iter().chain(b"\x1f") {
        match framer.push(*byte) {
            Some(Framed::Binary { kind, body }) => packets.push((kind, body.to_vec())),
            Some(other) => panic!("{other:?} in {}", line.escape_ascii()),
            None => {}
        }
    }
    assert_eq!(packets.len(), 1);
    packets.remove(0)
}

#[test]
fn crcs() {
    for vector in vectors("seals") {
        let direction = match text(&vector, "direction") {
            ">" => Direction::HostToRobot,
            "<" => Direction::RobotToHost,
            other => panic!("direction {other}"),
        };
        let crc = packet_crc(direction, session(&vector), text(&vector, "packet").as_bytes());
        assert_eq!(to_hex(crc), text(&vector, "seal").as_bytes(), "{vector}");
    }
}

#[test]
fn commands() {
    let mut seen = BTreeSet::new();
    for vector in vectors("commands") {
        let texts = checked_texts(&line(&vector), Direction::HostToRobot, session(&vector));
        let command =
            read_command(&texts[0], Form::Checked).unwrap_or_else(|refused| panic!("{refused:?}: {vector}"));
        assert_eq!(meaning::command(&command), vector["meaning"]);
        let mut buffer = PacketBuffer::new();
        write_command_with_crc(&command, session(&vector), &mut buffer).unwrap();
        assert_eq!(buffer.as_bytes(), line(&vector), "{vector}");
        seen.insert(command.name().name());
        if let Command::Drive(drive) = command {
            let on_line = from_hex(text(&vector, "binary_line_hex"));
            let (kind, body) = binary_body(&on_line, Direction::HostToRobot, session(&vector));
            assert_eq!((kind, binary::read_drive(&body)), (binary::DRIVE, Ok(drive)));
            buffer.clear();
            binary::write_drive_with_crc(&drive, session(&vector), &mut buffer).unwrap();
            assert_eq!(buffer.as_bytes(), [on_line.as_slice(), b"\x1f"].concat());
        }
    }
    let all: BTreeSet<_> = CommandName::ALL.into_iter().map(CommandName::name).collect();
    assert_eq!(seen, all, "every command has a vector");
}

/// What several packets of one report add up to.
fn gather(texts: &[Vec<u8>]) -> Report {
    let mut whole = InfoPart::default();
    for text in texts {
        match read_report(text).unwrap_or_else(|refusal| panic!("{refusal:?}: {}", text.escape_ascii())) {
            ReportPacket::Report(report) => return report,
            ReportPacket::Info(part) => {
                whole = InfoPart {
                    firmware: part.firmware.or(whole.firmware),
                    battery: part.battery.or(whole.battery),
                    link: part.link.or(whole.link),
                };
            }
        }
    }
    let firmware = whole.firmware.expect("an info tells versions");
    Report::Info(Info {
        firmware_version: firmware.firmware_version,
        cordlib_version: firmware.cordlib_version,
        main_steps_hz: firmware.main_steps_hz,
        battery: whole.battery,
        bandwidth_in: firmware.bandwidth_in,
        bandwidth_out: firmware.bandwidth_out,
        link: whole.link.expect("an info tells the link"),
        arming: firmware.arming,
    })
}

#[test]
fn reports() {
    let mut refusals = BTreeSet::new();
    for vector in vectors("reports") {
        let texts = checked_texts(&line(&vector), Direction::RobotToHost, session(&vector));
        let report = gather(&texts);
        assert_eq!(meaning::report(&report), vector["meaning"]);
        let mut buffer = PacketBuffer::new();
        write_report_with_crc(&report, session(&vector), &mut buffer).unwrap();
        assert_eq!(buffer.as_bytes(), line(&vector), "{vector}");
        match report {
            Report::State(state) => check_binary_state(&state, &vector),
            Report::Acknowledgement(answer) => refusals.extend(answer.refusal.map(Refusal::name)),
            _ => {}
        }
    }
    let all: BTreeSet<_> = Refusal::ALL.into_iter().map(Refusal::name).collect();
    assert_eq!(refusals, all, "every refusal has a vector");
}

fn check_binary_state(state: &State, vector: &Value) {
    let on_line = from_hex(text(vector, "binary_line_hex"));
    let (kind, body) = binary_body(&on_line, Direction::RobotToHost, session(vector));
    assert_eq!((kind, binary::read_state(&body)), (binary::STATE, Ok(*state)));
    let mut buffer = PacketBuffer::new();
    binary::write_state_with_crc(state, session(vector), &mut buffer).expect("a state fits");
    assert_eq!(buffer.as_bytes(), [on_line.as_slice(), b"\x1f"].concat());
}

#[test]
fn the_longest_packets_fit() {
    for file in ["commands", "reports"] {
        for vector in vectors(file) {
            for packet in text(&vector, "line").split('\x1f') {
                assert!(
                    packet.len() <= PACKET_BYTES_MAX,
                    "{} bytes: {packet}",
                    packet.len()
                );
            }
        }
    }
}

fn form(vector: &Value) -> Form {
    let now = Tick(vector["tick_ms"].as_u64().unwrap_or(0) as u32);
    match text(vector, "mode") {
        "sealed" => Form::Checked,
        "hand" => Form::Hand { now },
        "sealed hand" => Form::SealedHand { now },
        other => panic!("mode {other}"),
    }
}

#[test]
fn refused() {
    for vector in vectors("refused") {
        let refused =
            read_command(text(&vector, "text").as_bytes(), form(&vector)).expect_err(text(&vector, "text"));
        let found = json!({
            "refusal": refused.refusal.name(),
            "number": refused.sequence.map(|sequence| sequence.0),
        });
        let expected = json!({"refusal": vector["refusal"], "number": vector["number"]});
        assert_eq!(found, expected, "{vector}");
    }
}

#[test]
fn tolerated() {
    for vector in vectors("tolerated") {
        let command = read_command(text(&vector, "text").as_bytes(), form(&vector))
            .unwrap_or_else(|refused| panic!("{refused:?}: {vector}"));
        assert_eq!(meaning::command(&command), vector["meaning"], "{vector}");
    }
}

fn framed(framed: &Framed<'_>) -> Value {
    match framed {
        Framed::Unchecked(text) => json!({"open": hex(text)}),
        Framed::Checked(text) => json!({"sealed": hex(text)}),
        Framed::BadCrc { text, .. } => json!({"missealed": hex(text)}),
        Framed::Binary { kind, body } => json!({"binary": kind, "body": hex(body)}),
        Framed::BinaryBadCrc => json!("binary-missealed"),
        Framed::Poisoned(poison) => json!({"poisoned": poison_name(*poison)}),
    }
}

fn poison_name(poison: Poison) -> &'static str {
    match poison {
        Poison::TooLong => "too-long",
        Poison::ControlByte => "control-byte",
        Poison::FramingError => "framing-error",
        Poison::Overrun => "overrun",
    }
}

#[test]
fn framing() {
    for vector in vectors("framing") {
        let mut framer = Framer::new(Direction::HostToRobot);
        framer.set_session(session(&vector));
        let events: Vec<_> = from_hex(text(&vector, "stream_hex"))
            .into_iter()
            .filter_map(|byte| framer.push(byte).as_ref().map(framed))
            .collect();
        assert_eq!(Value::from(events), vector["events"], "{}", text(&vector, "name"));
    }
}

/// Every packet that the specification shows is understood, and the one with a CRC is a golden packet.
#[test]
fn examples_of_the_specification() {
    let path = format!("{}/../SPEC.md", env!("CARGO_MANIFEST_DIR"));
    let specification = std::fs::read_to_string(&path).unwrap();
    let examples: Vec<_> = specification
        .split('`')
        .filter(|quoted| quoted.starts_with('{'))
        .collect();
    assert!(
        examples.len() >= CommandName::ALL.len(),
        "{} examples",
        examples.len()
    );
    for example in examples {
        let command = read_command(example.as_bytes(), Form::Checked);
        let report = read_report(example.as_bytes());
        assert!(
            command.is_ok() || report.is_ok(),
            "{example}: {command:?}, {report:?}"
        );
    }
    let with_crc: Vec<_> = specification
        .lines()
        .filter_map(|line| line.strip_prefix("    {"))
        .collect();
    assert_eq!(with_crc.len(), 1);
    let golden = vectors("commands");
    assert!(
        golden
            .iter()
            .any(|vector| text(vector, "line").strip_prefix('{') == Some(with_crc[0])),
        "{with_crc:?}"
    );
}
