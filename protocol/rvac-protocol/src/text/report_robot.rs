//! Who the robot is: `hello` and the rows of `describe`.

use rvac_units::{AngularSpeed, Length, Speed, Tick};

use super::command_read::binary_kinds;
use super::command_write::binary_names;
use super::fields::{Fields, UnknownKeys, lists};
use super::write::ObjectWriter;
use crate::buffer::{EncodeError, PacketBuffer};
use crate::message::{
    Capabilities, CommandName, CommandNames, DescribeRow, Limits, MotorGaps, MotorSet, Name, Parameter,
    ProtocolVersion, Refusal, ResetCause, RobotHello, RowContent,
};
use crate::span;

/// A name of at most 24 bytes without escapes.
pub(super) fn read_name(bytes: &[u8]) -> Result<Name, Refusal> {
    core::str::from_utf8(bytes)
        .map_err(|_| Refusal::Syntax)
        .and_then(|name| Name::try_from(name).map_err(|_| Refusal::Range))
}

pub(super) fn write_hello(hello: &RobotHello, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
    ObjectWriter::new(buffer)
        .name("c", "hello")
        .number("min", hello.version_min.0, span::BYTE)
        .number("max", hello.version_max.0, span::BYTE)
        .name("device", &hello.device)
        .name("firmware", &hello.firmware)
        .number("session", hello.session, span::WORD)
        .number("packet", hello.packet_max, span::WORD)
        .number("boots", hello.boot_count, span::TOTAL)
        .name("reset", hello.reset_cause.name())
        .names("bin", binary_names(hello.binary))
        .number("t", hello.tick.0, span::TOTAL)
        .finish()
}

pub(super) fn read_hello(text: &[u8]) -> Result<RobotHello, Refusal> {
    const KEYS: [&str; 11] = [
        "c", "min", "max", "device", "firmware", "session", "packet", "boots", "reset", "bin", "t",
    ];
    let fields = Fields::read(text, KEYS, UnknownKeys::Ignore)?;
    Ok(RobotHello {
        version_min: ProtocolVersion(fields.byte(1)?),
        version_max: ProtocolVersion(fields.byte(2)?),
        device: read_name(fields.text(3)?)?,
        firmware: read_name(fields.text(4)?)?,
        session: fields.word(5, span::WORD)?,
        packet_max: fields.word(6, span::WORD)?,
        boot_count: fields.total(7)?,
        // A cause of a newer robot is unknown to this version.
        reset_cause: ResetCause::from_name(fields.text(8)?).unwrap_or(ResetCause::Unknown),
        binary: binary_kinds(fields.text_or_empty(9)?),
        tick: Tick(fields.total(10)?),
    })
}

pub(super) fn write_row(row: &DescribeRow, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
    let mut object = ObjectWriter::new(buffer);
    object
        .name("c", "describe")
        .number("row", row.row, span::BYTE)
        .number("rows", row.rows, span::BYTE);
    match &row.content {
        RowContent::Limits(limits) => write_limits(limits, object.name("of", "limits")),
        RowContent::Capabilities(parts) => write_parts(parts, object.name("of", "parts")),
        RowContent::Commands(commands) => object.name("of", "commands").names(
            "commands",
            CommandName::ALL
                .into_iter()
                .filter(|name| commands.contains(*name))
                .map(CommandName::name),
        ),
        RowContent::Parameter { parameter, min, max } => object
            .name("of", "parameter")
            .name("name", parameter.name())
            .number("min", *min, span::COUNT)
            .number("max", *max, span::COUNT),
        RowContent::Motors(gaps) => object
            .name("of", "motors")
            .names("unguarded", listed(gaps.unguarded))
            .names("unmeasured", listed(gaps.unmeasured)),
        RowContent::Unknown => &mut object,
    };
    object.finish()
}

fn write_limits<'o, 'b>(limits: &Limits, object: &'o mut ObjectWriter<'b>) -> &'o mut ObjectWriter<'b> {
    object
        .number("speed-max", limits.speed_max.0, span::MICRO)
        .number("turn-max", limits.turn_max.0, span::MICRO)
        .number("track", limits.track.0, span::MICRO)
        .number("count", limits.count_nm, span::NANO)
        .number("radius", limits.radius.0, span::MICRO)
        .number("swath", limits.swath.0, span::MICRO)
}

fn write_parts<'o, 'b>(parts: &Capabilities, object: &'o mut ObjectWriter<'b>) -> &'o mut ObjectWriter<'b> {
    let present = part_flags(parts)
        .into_iter()
        .filter_map(|(name, has)| has.then_some(name));
    object
        .number("bumpers", parts.bumpers, span::BYTE)
        .number("cliffs", parts.cliffs, span::BYTE)
        .number("wheel-drops", parts.wheel_drops, span::BYTE)
        .number("proximity", parts.proximity, span::BYTE)
        .number("dock-receivers", parts.dock_receivers, span::BYTE)
        .number("buttons", parts.buttons, span::BYTE)
        .number("leds", parts.leds, span::BYTE)
        .names("has", present)
}

fn listed(motors: MotorSet) -> impl Iterator<Item = &'static str> {
    motors
        .named()
        .into_iter()
        .filter_map(|(name, is_listed)| is_listed.then_some(name))
}

fn read_gaps(text: &[u8]) -> Result<MotorGaps, Refusal> {
    let fields = Fields::read(text, ["unguarded", "unmeasured"], UnknownKeys::Ignore)?;
    Ok(MotorGaps {
        unguarded: read_motors(fields.text_or_empty(0)?),
        unmeasured: read_motors(fields.text_or_empty(1)?),
    })
}

fn read_motors(words: &[u8]) -> MotorSet {
    MotorSet {
        wheels: lists(words, "wheels"),
        brush_main: lists(words, "brush-main"),
        brush_sides: lists(words, "brush-sides"),
        vacuum: lists(words, "vacuum"),
    }
}

fn part_flags(parts: &Capabilities) -> [(&'static str, bool); 10] {
    [
        ("encoders", parts.encoders),
        ("gyro", parts.gyro),
        ("beeper", parts.beeper),
        ("brush-main", parts.brush_main),
        ("brush-sides", parts.brush_sides),
        ("vacuum", parts.vacuum),
        ("currents", parts.currents),
        ("battery", parts.battery),
        ("charger", parts.charger),
        ("probe", parts.probe),
    ]
}

pub(super) fn read_row(text: &[u8]) -> Result<DescribeRow, Refusal> {
    let fields = Fields::read(text, ["c", "row", "rows", "of"], UnknownKeys::Ignore)?;
    Ok(DescribeRow {
        row: fields.byte(1)?,
        rows: fields.byte(2)?,
        content: match fields.text_or_empty(3)? {
            b"limits" => read_limits(text).map(RowContent::Limits)?,
            b"parts" => read_parts(text).map(RowContent::Capabilities)?,
            b"commands" => read_commands(text).map(RowContent::Commands)?,
            b"parameter" => read_parameter(text)?,
            b"motors" => read_gaps(text).map(RowContent::Motors)?,
            _ => RowContent::Unknown,
        },
    })
}

fn read_limits(text: &[u8]) -> Result<Limits, Refusal> {
    const KEYS: [&str; 6] = ["speed-max", "turn-max", "track", "count", "radius", "swath"];
    let fields = Fields::read(text, KEYS, UnknownKeys::Ignore)?;
    let micro = |index| fields.int(index, span::MICRO);
    Ok(Limits {
        speed_max: Speed(micro(0)?),
        turn_max: AngularSpeed(micro(1)?),
        track: Length(micro(2)?),
        count_nm: u32::try_from(fields.number(3, span::NANO)?).map_err(|_| Refusal::Range)?,
        radius: Length(micro(4)?),
        swath: Length(micro(5)?),
    })
}

fn read_parts(text: &[u8]) -> Result<Capabilities, Refusal> {
    const KEYS: [&str; 8] = [
        "bumpers",
        "cliffs",
        "wheel-drops",
        "proximity",
        "dock-receivers",
        "buttons",
        "leds",
        "has",
    ];
    let fields = Fields::read(text, KEYS, UnknownKeys::Ignore)?;
    let words = fields.text_or_empty(7)?;
    Ok(Capabilities {
        encoders: lists(words, "encoders"),
        gyro: lists(words, "gyro"),
        bumpers: fields.byte(0)?,
        cliffs: fields.byte(1)?,
        wheel_drops: fields.byte(2)?,
        proximity: fields.byte(3)?,
        dock_receivers: fields.byte(4)?,
        buttons: fields.byte(5)?,
        leds: fields.byte(6)?,
        beeper: lists(words, "beeper"),
        brush_main: lists(words, "brush-main"),
        brush_sides: lists(words, "brush-sides"),
        vacuum: lists(words, "vacuum"),
        currents: lists(words, "currents"),
        battery: lists(words, "battery"),
        charger: lists(words, "charger"),
        probe: lists(words, "probe"),
    })
}

fn read_commands(text: &[u8]) -> Result<CommandNames, Refusal> {
    let fields = Fields::read(text, ["commands"], UnknownKeys::Ignore)?;
    let mut commands = CommandNames::NONE;
    for word in fields.text(0)?.split(|byte| *byte == b' ') {
        if let Some(name) = CommandName::from_name(word) {
            commands.insert(name);
        }
    }
    Ok(commands)
}

fn read_parameter(text: &[u8]) -> Result<RowContent, Refusal> {
    let fields = Fields::read(text, ["name", "min", "max"], UnknownKeys::Ignore)?;
    Ok(match Parameter::from_name(fields.text(0)?) {
        Some(parameter) => RowContent::Parameter {
            parameter,
            min: fields.int(1, span::COUNT)?,
            max: fields.int(2, span::COUNT)?,
        },
        None => RowContent::Unknown,
    })
}
