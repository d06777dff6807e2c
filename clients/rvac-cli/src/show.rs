//! Packets for human eyes: the verdict on the CRC, the meaning, the text twin of a binary packet.

use rvac_protocol::PacketBuffer;
use rvac_protocol::binary;
use rvac_protocol::crc::{Direction, packet_crc, to_hex};
use rvac_protocol::frame::{Framed, Framer, Poison, SEPARATOR};
use rvac_protocol::message::{Command, Refusal, Report};
use rvac_protocol::text::{Form, ReportPacket, read_command, read_report, write_command, write_report};
use rvac_units::Tick;

/// How a packet was protected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// The right CRC of the session.
    Checked,
    /// The right CRC of no session: handshakes.
    CheckedBeforeSession,
    /// No CRC.
    NoCrc,
    /// A wrong CRC.
    BadCrc {
        /// The one it came with, if it can be read.
        found: Option<u32>,
        /// The one it should have, if it can be computed.
        expected: Option<u32>,
    },
    /// Not whole.
    Broken(Poison),
}

/// One packet, examined.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shown {
    pub(crate) verdict: Verdict,
    /// The JSON text; of a binary packet its twin; of a broken one nothing.
    pub(crate) text: String,
    pub(crate) binary: bool,
    /// What it means, or the reason for which its receiver refuses it.
    pub(crate) meaning: Result<String, Refusal>,
}

impl Shown {
    pub(crate) fn is_good(&self) -> bool {
        let whole = !matches!(self.verdict, Verdict::BadCrc { .. } | Verdict::Broken(_));
        whole && self.meaning.is_ok()
    }

    /// Whether it is a packet with this word: the value of `c` or `e`, `ack` for answers.
    pub(crate) fn has_word(&self, word: &str) -> bool {
        let Ok(serde_json::Value::Object(object)) = serde_json::from_str(&self.text) else {
            return false;
        };
        let named = ["c", "e"]
            .iter()
            .filter_map(|key| object.get(*key))
            .any(|value| value == word);
        named || (word == "ack" && object.contains_key("a"))
    }

    /// One line: the text, marked where something is wrong.
    pub(crate) fn line(&self) -> String {
        let mut line = String::new();
        if !self.is_good() {
            line += "BAD ";
        }
        line += &self.text;
        if self.binary {
            line += " (binary)";
        }
        match self.verdict {
            Verdict::Checked | Verdict::CheckedBeforeSession => {}
            _ => line += &format!(" [{}]", self.verdict.in_words()),
        }
        if let Err(refusal) = self.meaning
            && !matches!(self.verdict, Verdict::Broken(_))
        {
            line += &format!(" [refused: {}]", refusal.name());
        }
        line
    }
}

impl Verdict {
    pub(crate) fn in_words(self) -> String {
        let hex = |crc: u32| String::from_utf8_lossy(&to_hex(crc)).into_owned();
        match self {
            Self::Checked => "CRC right".to_owned(),
            Self::CheckedBeforeSession => "CRC right, without a session".to_owned(),
            Self::NoCrc => "no CRC".to_owned(),
            Self::BadCrc {
                found: Some(found),
                expected: Some(expected),
            } => {
                format!("wrong CRC: {} instead of {}", hex(found), hex(expected))
            }
            Self::BadCrc { .. } => "wrong CRC".to_owned(),
            Self::Broken(Poison::TooLong) => "broken: too long".to_owned(),
            Self::Broken(Poison::ControlByte) => "broken: forbidden control byte".to_owned(),
            Self::Broken(Poison::FramingError) => "broken: framing error".to_owned(),
            Self::Broken(Poison::Overrun) => "broken: bytes lost".to_owned(),
        }
    }
}

/// Looks at the packets of one direction.
#[derive(Clone, Debug)]
pub(crate) struct Viewer {
    framer: Framer,
    direction: Direction,
    session: u16,
}

impl Viewer {
    pub(crate) fn new(direction: Direction, session: u16) -> Self {
        let mut framer = Framer::new(direction);
        framer.set_session(session);
        Self {
            framer,
            direction,
            session,
        }
    }

    pub(crate) fn set_session(&mut self, session: u16) {
        self.session = session;
        self.framer.set_session(session);
    }

    /// Takes a byte; the end of a packet gives what it was.
    pub(crate) fn push(&mut self, byte: u8) -> Option<Shown> {
        let (direction, session) = (self.direction, self.session);
        self.framer
            .push(byte)
            .map(|framed| look(framed, direction, session))
    }

    /// The packets in `bytes`, the last one ended by force.
    pub(crate) fn packets(&mut self, bytes: &[u8]) -> Vec<Shown> {
        bytes
            .iter()
            .chain([&SEPARATOR])
            .filter_map(|byte| self.push(*byte))
            .collect()
    }
}

fn look(framed: Framed<'_>, direction: Direction, session: u16) -> Shown {
    match framed {
        Framed::Checked(text) => text_packet(text, Verdict::Checked, direction),
        Framed::Unchecked(text) => text_packet(text, Verdict::NoCrc, direction),
        Framed::BadCrc { text, crc: found } => {
            let verdict = if found == packet_crc(direction, 0, text) {
                Verdict::CheckedBeforeSession
            } else {
                Verdict::BadCrc {
                    found: Some(found),
                    expected: Some(packet_crc(direction, session, text)),
                }
            };
            text_packet(text, verdict, direction)
        }
        Framed::Binary { kind, body } => binary_packet(kind, body),
        Framed::BinaryBadCrc => {
            let verdict = Verdict::BadCrc {
                found: None,
                expected: None,
            };
            Shown {
                verdict,
                text: String::new(),
                binary: true,
                meaning: Err(Refusal::Syntax),
            }
        }
        Framed::Poisoned(poison) => {
            let verdict = Verdict::Broken(poison);
            Shown {
                verdict,
                text: String::new(),
                binary: false,
                meaning: Err(Refusal::Syntax),
            }
        }
    }
}

fn text_packet(text: &[u8], verdict: Verdict, direction: Direction) -> Shown {
    let meaning = match direction {
        Direction::HostToRobot => command_meaning(text, verdict),
        Direction::RobotToHost => read_report(text).map(|packet| match packet {
            ReportPacket::Report(report) => format!("{report:?}"),
            ReportPacket::Info(part) => format!("{part:?}"),
        }),
    };
    Shown {
        verdict,
        text: String::from_utf8_lossy(text).into_owned(),
        binary: false,
        meaning,
    }
}

fn command_meaning(text: &[u8], verdict: Verdict) -> Result<String, Refusal> {
    if text.iter().all(|byte| *byte == b'U') {
        return Ok("baud rate pattern".to_owned());
    }
    if rvac_protocol::text::is_stop(text) {
        return Ok(format!("{:?}", Command::Stop));
    }
    let form = if verdict == Verdict::NoCrc {
        Form::Hand { now: Tick(0) }
    } else {
        Form::Checked
    };
    read_command(text, form)
        .map(|command| format!("{command:?}"))
        .map_err(|refused| refused.refusal)
}

fn binary_packet(kind: u8, body: &[u8]) -> Shown {
    let mut buffer = PacketBuffer::new();
    let meaning = match kind {
        binary::STATE => binary::read_state(body).map(|state| {
            let report = Report::State(state);
            write_report(&report, &mut buffer).ok();
            format!("{report:?}")
        }),
        binary::DRIVE => binary::read_drive(body).map(|drive| {
            let command = Command::Drive(drive);
            write_command(&command, &mut buffer).ok();
            format!("{command:?}")
        }),
        _ => Err(Refusal::Unknown),
    };
    let text = String::from_utf8_lossy(buffer.as_bytes()).into_owned();
    Shown {
        verdict: Verdict::Checked,
        text,
        binary: true,
        meaning,
    }
}
