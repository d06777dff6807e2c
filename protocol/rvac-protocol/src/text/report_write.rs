//! Reports to text.

use super::write::ObjectWriter;
use super::{report_event, report_info, report_probe, report_robot, report_state};
use crate::buffer::{EncodeError, PacketBuffer};
use crate::crc::Direction;
use crate::message::{Acknowledgement, Info, LogLevel, Report};
use crate::span;

/// Appends a report with its CRC for `session`: one packet and its separator, or three for `info`.
///
/// # Errors
/// [`EncodeError::TooLong`] if the buffer is full. Every report fits an empty buffer; a log text is cut at its packet's
/// end.
pub fn write_report_with_crc(
    report: &Report,
    session: u16,
    buffer: &mut PacketBuffer,
) -> Result<(), EncodeError> {
    let mut write_packet = |write: &dyn Fn(&mut PacketBuffer) -> Result<(), EncodeError>| {
        let start = buffer.length();
        write(buffer)?;
        buffer.append_crc(start, Direction::RobotToHost, session)
    };
    if let Report::Info(info) = report {
        for part in [InfoPacket::Battery, InfoPacket::Link] {
            if part != InfoPacket::Battery || info.battery.is_some() {
                write_packet(&|buffer| write_info_packet(info, part, buffer))?;
            }
        }
    }
    write_packet(&|buffer| write_report(report, buffer))
}

/// Appends a report as text, without a CRC. Of an `info` it is the last packet, the one with the versions.
///
/// # Errors
/// As [`write_report_with_crc`].
pub fn write_report(report: &Report, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
    match report {
        Report::Hello(hello) => report_robot::write_hello(hello, buffer),
        Report::Describe(row) => report_robot::write_row(row, buffer),
        Report::Info(info) => report_info::write_firmware(info, buffer),
        Report::State(state) => report_state::write(state, &mut ObjectWriter::new(buffer)),
        Report::Event(event) => report_event::write(event, buffer),
        Report::Acknowledgement(answer) => write_answer(answer, buffer),
        Report::Probed(probed) => report_probe::write(probed, buffer),
        Report::Log { level, text } => ObjectWriter::new(buffer)
            .name("c", "log")
            .name("level", level_name(*level))
            .prose("str", text)
            .finish(),
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum InfoPacket {
    Battery,
    Link,
}

fn write_info_packet(info: &Info, packet: InfoPacket, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
    match (packet, &info.battery) {
        (InfoPacket::Battery, Some(battery)) => report_info::write_battery(battery, buffer),
        (InfoPacket::Battery, None) => Ok(()),
        (InfoPacket::Link, _) => report_info::write_link(&info.link, buffer),
    }
}

fn write_answer(answer: &Acknowledgement, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
    let mut object = ObjectWriter::new(buffer);
    match answer.sequence {
        Some(sequence) => object.number("a", sequence.0, span::WORD),
        None => object.null("a"),
    };
    if let Some(refusal) = answer.refusal {
        object.name("err", refusal.name());
    }
    object.finish()
}

/// The name of a level on the wire.
pub(super) const fn level_name(level: LogLevel) -> &'static str {
    match level {
        LogLevel::Debug => "debug",
        LogLevel::Info => "info",
        LogLevel::Warn => "warn",
        LogLevel::Error => "error",
    }
}
