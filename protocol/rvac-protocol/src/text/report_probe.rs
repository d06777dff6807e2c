//! Raw readings: `probed`.

use rvac_units::Tick;

use super::fields::{Fields, UnknownKeys};
use super::write::ObjectWriter;
use crate::buffer::{EncodeError, PacketBuffer};
use crate::message::{ButtonProbe, EncoderProbe, PROBE_BYTES, Probed, ProbedContent, Refusal, SerialProbe};
use crate::span;

pub(super) fn write(probed: &Probed, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
    let mut object = ObjectWriter::new(buffer);
    object.name("c", "probed");
    match &probed.content {
        ProbedContent::Analog(counts) => object.name("of", "analog").numbers("raw", counts),
        ProbedContent::Encoders(encoders) => write_encoders(encoders, &mut object),
        ProbedContent::Lines(ports) => object.name("of", "lines").hex_words("ports", ports),
        ProbedContent::Buttons(buttons) => object
            .name("of", "buttons")
            .number("level", buttons.level, span::WORD)
            .flag("pressed", buttons.pressed),
        ProbedContent::Serial(serial) => object
            .name("of", "serial")
            .number("at", serial.at, span::TOTAL)
            .number("lost", serial.lost, span::TOTAL)
            .hex("bytes", &serial.bytes),
    };
    object.number("t", probed.tick.0, span::TOTAL).finish()
}

fn write_encoders<'a, 'b>(
    encoders: &EncoderProbe,
    object: &'a mut ObjectWriter<'b>,
) -> &'a mut ObjectWriter<'b> {
    object
        .name("of", "encoders")
        .number("left", encoders.left, span::COUNT)
        .number("right", encoders.right, span::COUNT)
        .number("left-illegal", encoders.left_illegal, span::TOTAL)
        .number("right-illegal", encoders.right_illegal, span::TOTAL);
    match encoders.brush {
        Some(pulses) => object.number("brush", pulses, span::TOTAL),
        None => object,
    }
}

pub(super) fn read(text: &[u8]) -> Result<Probed, Refusal> {
    let fields = Fields::read(text, ["c", "of", "t"], UnknownKeys::Ignore)?;
    let content = match fields.text(1)? {
        b"analog" => ProbedContent::Analog(read_list(text, "raw", decimal)?),
        b"encoders" => ProbedContent::Encoders(read_encoders(text)?),
        b"lines" => ProbedContent::Lines(read_list(text, "ports", hexadecimal)?),
        b"buttons" => ProbedContent::Buttons(read_buttons(text)?),
        b"serial" => ProbedContent::Serial(read_serial(text)?),
        _ => return Err(Refusal::Unknown),
    };
    Ok(Probed {
        tick: Tick(fields.total(2)?),
        content,
    })
}

fn read_encoders(text: &[u8]) -> Result<EncoderProbe, Refusal> {
    let keys = ["left", "right", "left-illegal", "right-illegal", "brush"];
    let fields = Fields::read(text, keys, UnknownKeys::Ignore)?;
    Ok(EncoderProbe {
        left: fields.int(0, span::COUNT)?,
        right: fields.int(1, span::COUNT)?,
        left_illegal: fields.total(2)?,
        right_illegal: fields.total(3)?,
        brush: if fields.has(4) {
            Some(fields.total(4)?)
        } else {
            None
        },
    })
}

fn read_buttons(text: &[u8]) -> Result<ButtonProbe, Refusal> {
    let fields = Fields::read(text, ["level", "pressed"], UnknownKeys::Ignore)?;
    Ok(ButtonProbe {
        level: fields.word(0, span::WORD)?,
        pressed: fields.flag(1)?,
    })
}

fn read_serial(text: &[u8]) -> Result<SerialProbe, Refusal> {
    let fields = Fields::read(text, ["at", "lost", "bytes"], UnknownKeys::Ignore)?;
    let digits = fields.text(2)?;
    let (pairs, rest) = digits.as_chunks::<2>();
    if pairs.len() > PROBE_BYTES || !rest.is_empty() {
        return Err(Refusal::Range);
    }
    let mut serial = SerialProbe {
        at: fields.total(0)?,
        lost: fields.total(1)?,
        ..SerialProbe::default()
    };
    for pair in pairs {
        let byte = hexadecimal(pair).ok_or(Refusal::Syntax)?;
        let byte = u8::try_from(byte).map_err(|_| Refusal::Syntax)?;
        serial.bytes.push(byte).map_err(|_| Refusal::Range)?;
    }
    Ok(serial)
}

/// Exactly `N` words under `key`, with one space between them.
fn read_list<const N: usize>(
    text: &[u8],
    key: &str,
    word: fn(&[u8]) -> Option<u16>,
) -> Result<[u16; N], Refusal> {
    let fields = Fields::read(text, [key], UnknownKeys::Ignore)?;
    let mut words = fields.text(0)?.split(|byte| *byte == b' ');
    let mut values = [0; N];
    for value in &mut values {
        *value = words.next().and_then(word).ok_or(Refusal::Range)?;
    }
    if words.next().is_some() {
        return Err(Refusal::Range);
    }
    Ok(values)
}

fn decimal(digits: &[u8]) -> Option<u16> {
    number(digits, 10)
}

fn hexadecimal(digits: &[u8]) -> Option<u16> {
    number(digits, 16)
}

fn number(digits: &[u8], radix: u32) -> Option<u16> {
    if digits.is_empty() {
        return None;
    }
    let mut value: u32 = 0;
    for digit in digits {
        let digit = (*digit as char).to_digit(radix)?;
        value = value.checked_mul(radix)?.checked_add(digit)?;
    }
    u16::try_from(value).ok()
}
