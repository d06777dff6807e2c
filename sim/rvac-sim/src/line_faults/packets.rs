//! Packets of one direction of the line, each with its bytes as they were.

use rvac_protocol::PacketBuffer;
use rvac_protocol::binary;
use rvac_protocol::crc::Direction;
use rvac_protocol::frame::{Framed, Framer, SEPARATOR};
use rvac_protocol::message::{Command, Report, State};
use rvac_protocol::text::{self, Form, ReportPacket};

/// What a packet is, as far as a fault changes it.
#[derive(Clone, Debug)]
pub(super) enum Content {
    /// A report of the state.
    State { state: Box<State>, form: WireForm },
    /// A command.
    Command { command: Box<Command>, form: WireForm },
    /// A greeting that opens this session, or closes the one before.
    Session(u16),
    /// Anything else.
    Other,
}

/// How it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WireForm {
    Text,
    Binary,
}

/// A packet and its bytes with the separator.
#[derive(Clone, Debug)]
pub(super) struct Packet {
    pub(super) bytes: Vec<u8>,
    pub(super) content: Content,
}

/// Splits bytes into packets.
#[derive(Debug)]
pub(super) struct PacketReader {
    direction: Direction,
    framer: Framer,
    session: u16,
    bytes: Vec<u8>,
}

impl PacketReader {
    pub(super) fn new(direction: Direction) -> Self {
        Self {
            direction,
            framer: Framer::new(direction),
            session: 0,
            bytes: Vec::new(),
        }
    }

    /// Packets are sealed with this number from the next one on.
    pub(super) fn set_session(&mut self, session: u16) {
        self.session = session;
        self.framer.set_session(session);
    }

    /// Takes a byte; a separator gives the packet that it ends, which may be empty.
    pub(super) fn push(&mut self, byte: u8) -> Option<Packet> {
        self.bytes.push(byte);
        let content = match self.framer.push(byte) {
            Some(Framed::Checked(text)) => read_text(self.direction, text),
            // A greeting is sealed with the number 0 always.
            Some(Framed::BadCrc { text, .. }) => read_greeting(text),
            Some(Framed::Binary { kind, body }) => read_binary(kind, body),
            Some(_) | None => Content::Other,
        };
        (byte == SEPARATOR).then(|| Packet {
            bytes: core::mem::take(&mut self.bytes),
            content,
        })
    }

    /// The bytes of this content, sealed for the present session.
    pub(super) fn write(&self, content: &Content) -> Vec<u8> {
        let mut buffer = PacketBuffer::new();
        let written = match content {
            Content::State { state, form } => match form {
                WireForm::Binary => binary::write_state_with_crc(state, self.session, &mut buffer),
                WireForm::Text => {
                    text::write_report_with_crc(&Report::State(**state), self.session, &mut buffer)
                }
            },
            Content::Command { command, form } => match (form, &**command) {
                (WireForm::Binary, Command::Drive(drive)) => {
                    binary::write_drive_with_crc(drive, self.session, &mut buffer)
                }
                (_, command) => text::write_command_with_crc(command, self.session, &mut buffer),
            },
            Content::Session(_) | Content::Other => return Vec::new(),
        };
        written.expect("it was read from a packet, so it fits into one");
        buffer.as_bytes().to_vec()
    }
}

fn read_text(direction: Direction, packet: &[u8]) -> Content {
    let form = WireForm::Text;
    match direction {
        Direction::RobotToHost => match text::read_report(packet) {
            Ok(ReportPacket::Report(Report::State(state))) => Content::State {
                state: Box::new(state),
                form,
            },
            _ => read_greeting(packet),
        },
        Direction::HostToRobot => {
            text::read_command(packet, Form::Checked).map_or(Content::Other, |command| Content::Command {
                command: Box::new(command),
                form,
            })
        }
    }
}

fn read_greeting(packet: &[u8]) -> Content {
    match text::read_report(packet) {
        Ok(ReportPacket::Report(Report::Hello(hello))) => Content::Session(hello.session),
        _ => Content::Other,
    }
}

fn read_binary(kind: u8, body: &[u8]) -> Content {
    let form = WireForm::Binary;
    match kind {
        binary::STATE => binary::read_state(body).map_or(Content::Other, |state| Content::State {
            state: Box::new(state),
            form,
        }),
        binary::DRIVE => binary::read_drive(body).map_or(Content::Other, |drive| Content::Command {
            command: Box::new(Command::Drive(drive)),
            form,
        }),
        _ => Content::Other,
    }
}
