//! Reports from text.

use super::fields::{Fields, UnknownKeys};
use super::report_info::InfoPart;
use super::report_write::level_name;
use super::scan::{Members, Value};
use super::{report_event, report_info, report_probe, report_robot, report_state};
use crate::message::{Acknowledgement, LogLevel, LogText, Refusal, Report, Sequence};
use crate::span;

/// Content of one packet of the robot.
#[derive(Clone, Debug, PartialEq)]
pub enum ReportPacket {
    /// A whole report. Never `Report::Info`.
    Report(Report),
    /// A part of an `info` report.
    Info(InfoPart),
}

/// Reads a report.
///
/// # Errors
/// Why it cannot be read. [`Refusal::Unknown`] means a packet of a newer robot, not a broken one.
pub fn read_report(text: &[u8]) -> Result<ReportPacket, Refusal> {
    let mut members = Members::of(text)?;
    while let Some((key, value)) = members.next()? {
        match key {
            b"c" => return read_named(text, value.text()?),
            b"e" => {
                return report_event::read(text, value.text()?)
                    .map(|event| ReportPacket::Report(Report::Event(event)));
            }
            b"a" => {
                return read_answer(text).map(|answer| ReportPacket::Report(Report::Acknowledgement(answer)));
            }
            _ => {}
        }
    }
    Err(Refusal::Missing)
}

fn read_named(text: &[u8], word: &[u8]) -> Result<ReportPacket, Refusal> {
    Ok(ReportPacket::Report(match word {
        b"state" => Report::State(report_state::read(text)?),
        b"info" => return report_info::read(text).map(ReportPacket::Info),
        b"hello" => Report::Hello(report_robot::read_hello(text)?),
        b"describe" => Report::Describe(report_robot::read_row(text)?),
        b"probed" => Report::Probed(report_probe::read(text)?),
        b"log" => read_log(text)?,
        _ => return Err(Refusal::Unknown),
    }))
}

fn read_answer(text: &[u8]) -> Result<Acknowledgement, Refusal> {
    let fields = Fields::read(text, ["a", "err"], UnknownKeys::Ignore)?;
    let sequence = match fields.get(0) {
        Some(Value::Null) => None,
        _ => Some(Sequence(fields.word(0, span::WORD)?)),
    };
    let refusal = match fields.get(1) {
        Some(name) => Some(Refusal::from_name(name.text()?).ok_or(Refusal::Unknown)?),
        None => None,
    };
    Ok(Acknowledgement { sequence, refusal })
}

fn read_log(text: &[u8]) -> Result<Report, Refusal> {
    let fields = Fields::read(text, ["c", "level", "str"], UnknownKeys::Ignore)?;
    let name = fields.text_or_empty(1)?;
    let level = [LogLevel::Debug, LogLevel::Info, LogLevel::Warn, LogLevel::Error]
        .into_iter()
        .find(|level| level_name(*level).as_bytes() == name)
        // Firmware of 2016 sends no level, and an unknown level does not make the line useless.
        .unwrap_or(LogLevel::Info);
    Ok(Report::Log {
        level,
        text: unescape(fields.text(2)?)?,
    })
}

/// Decodes the escapes of a JSON string; text beyond the length of a log line is cut at a character.
fn unescape(raw: &[u8]) -> Result<LogText, Refusal> {
    let raw = core::str::from_utf8(raw).map_err(|_| Refusal::Syntax)?;
    let mut text = LogText::new();
    let mut rest = raw.chars();
    while let Some(character) = rest.next() {
        let character = if character == '\\' {
            unescape_one(&mut rest)?
        } else {
            character
        };
        if text.push(character).is_err() {
            break;
        }
    }
    Ok(text)
}

fn unescape_one(rest: &mut core::str::Chars<'_>) -> Result<char, Refusal> {
    match rest.next() {
        Some('n') => Ok('\n'),
        Some('r') => Ok('\r'),
        Some('t') => Ok('\t'),
        Some('b') => Ok('\u{8}'),
        Some('f') => Ok('\u{C}'),
        Some('u') => {
            let high = unescape_unit(rest)?;
            if !(0xD800..0xDC00).contains(&high) {
                return Ok(char::from_u32(high).unwrap_or(char::REPLACEMENT_CHARACTER));
            }
            unescape_low_surrogate(high, rest)
        }
        Some(character) => Ok(character),
        None => Err(Refusal::Syntax),
    }
}

fn unescape_low_surrogate(high: u32, rest: &mut core::str::Chars<'_>) -> Result<char, Refusal> {
    let mut ahead = rest.clone();
    if ahead.next() != Some('\\') || ahead.next() != Some('u') {
        return Ok(char::REPLACEMENT_CHARACTER);
    }
    let low = unescape_unit(&mut ahead)?;
    if !(0xDC00..0xE000).contains(&low) {
        return Ok(char::REPLACEMENT_CHARACTER);
    }
    *rest = ahead;
    let code = 0x1_0000 + ((high - 0xD800) << 10) + (low - 0xDC00);
    Ok(char::from_u32(code).unwrap_or(char::REPLACEMENT_CHARACTER))
}

fn unescape_unit(rest: &mut core::str::Chars<'_>) -> Result<u32, Refusal> {
    let mut unit = 0;
    for _ in 0..4 {
        let digit = rest
            .next()
            .and_then(|digit| digit.to_digit(16))
            .ok_or(Refusal::Syntax)?;
        unit = unit << 4 | digit;
    }
    Ok(unit)
}
