//! Commands to text.

use super::write::ObjectWriter;
use crate::buffer::{EncodeError, PacketBuffer};
use crate::crc::Direction;
use crate::message::{BinaryKinds, Command, Parameter, Probe, ProbeTarget, Sequence};
use crate::span;

/// Appends a command with its CRC for `session`, and a separator.
///
/// # Errors
/// [`EncodeError::Range`] if a number is out of range; the buffer is then unchanged.
pub fn write_command_with_crc(
    command: &Command,
    session: u16,
    buffer: &mut PacketBuffer,
) -> Result<(), EncodeError> {
    let start = buffer.length();
    write_command(command, buffer)?;
    buffer.append_crc(start, Direction::HostToRobot, session)
}

/// Appends a command as text, without a CRC.
///
/// # Errors
/// As [`write_command_with_crc`].
pub fn write_command(command: &Command, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
    let mut object = ObjectWriter::new(buffer);
    object.name("c", command.name().name());
    write_members(command, &mut object);
    object.finish()
}

fn write_members(command: &Command, object: &mut ObjectWriter<'_>) {
    match command {
        Command::Hello(hello) => object
            .number("min", hello.version_min.0, span::BYTE)
            .number("max", hello.version_max.0, span::BYTE)
            .names("bin", binary_names(hello.binary)),
        Command::Hand | Command::Info | Command::State | Command::Stop => object,
        Command::Describe { row } => object.number("row", *row, span::BYTE),
        Command::Drive(drive) => object
            .number("v", drive.speed.0, span::SPEED)
            .number("w", drive.turn.0, span::TURN)
            .number("ttl", drive.lease_ms, span::LEASE)
            .number("n", drive.sequence.0, span::WORD)
            .number("t", drive.seen_tick.0, span::TOTAL),
        Command::Motor(motor) => object
            .name("motor", motor.motor.name())
            .number("throttle", motor.throttle.millionths(), span::THROTTLE)
            .number("ttl", motor.lease_ms, span::LEASE)
            .number("n", motor.sequence.0, span::WORD)
            .number("t", motor.seen_tick.0, span::TOTAL),
        Command::Move(movement) => {
            object.number("length", movement.length.0, span::MOVE_LENGTH);
            match movement.radius {
                Some(radius) => object.number("radius", radius.0, span::MOVE_RADIUS),
                None => object.null("radius"),
            };
            write_sequence(object, movement.sequence).number("t", movement.seen_tick.0, span::TOTAL)
        }
        Command::Beep(beep) => write_pitch(object, beep.pitch.0)
            .number("duration", beep.duration_ms, span::DURATION)
            .number("volume", beep.volume.millionths(), span::RATIO),
        Command::Led(led) => object
            .number("led", led.led, span::LED)
            .name("pattern", led.pattern.name())
            .number("brightness", led.brightness.millionths(), span::RATIO),
        Command::Arm { sequence, undock } => write_sequence(object.flag("undock", *undock), *sequence),
        Command::Clear { sequence, inhibit } => {
            write_sequence(object.name("inhibit", inhibit.name()), *sequence)
        }
        Command::Set {
            sequence,
            parameter,
            value,
        } => {
            let object = object.name("name", parameter.name());
            write_sequence(write_value(object, *parameter, *value), *sequence)
        }
        Command::Ping { sequence } => write_sequence(object, *sequence),
        Command::Seen { event } => object.number("n", *event, span::WORD),
        Command::Charge { sequence, wanted } => write_sequence(object.flag("on", *wanted), *sequence),
        Command::Probe(probe) => write_probe(object, probe),
    };
}

fn write_sequence<'o, 'b>(object: &'o mut ObjectWriter<'b>, sequence: Sequence) -> &'o mut ObjectWriter<'b> {
    object.number("n", sequence.0, span::WORD)
}

fn write_probe<'o, 'b>(object: &'o mut ObjectWriter<'b>, probe: &Probe) -> &'o mut ObjectWriter<'b> {
    object.name("of", target_name(probe.target));
    if let ProbeTarget::Serial { port, baud } = probe.target {
        object
            .number("port", port, span::BYTE)
            .number("baud", baud, span::BAUD);
    }
    object.number("ttl", probe.lease_ms, span::PROBE_LEASE);
    write_sequence(object, probe.sequence)
}

/// The name of a target on the wire.
const fn target_name(target: ProbeTarget) -> &'static str {
    match target {
        ProbeTarget::Analog => "analog",
        ProbeTarget::Encoders => "encoders",
        ProbeTarget::Lines => "lines",
        ProbeTarget::Buttons => "buttons",
        ProbeTarget::Serial { .. } => "serial",
    }
}

fn write_pitch<'o, 'b>(object: &'o mut ObjectWriter<'b>, pitch_hz: i32) -> &'o mut ObjectWriter<'b> {
    if span::is_pitch(i64::from(pitch_hz)) {
        object.number("pitch", pitch_hz, span::PITCH)
    } else {
        object.out_of_range()
    }
}

fn write_value<'o, 'b>(
    object: &'o mut ObjectWriter<'b>,
    parameter: Parameter,
    value: i32,
) -> &'o mut ObjectWriter<'b> {
    let (min, max) = parameter.range();
    if value == 0 || (min..=max).contains(&value) {
        object.number("value", value, span::COUNT)
    } else {
        object.out_of_range()
    }
}

/// The names of the kinds in the set.
pub(super) fn binary_names(kinds: BinaryKinds) -> impl Iterator<Item = &'static str> {
    [("state", kinds.state), ("drive", kinds.drive)]
        .into_iter()
        .filter_map(|(name, agreed)| agreed.then_some(name))
}
