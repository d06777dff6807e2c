//! Events as text.

use rvac_units::Tick;

use super::fields::{Fields, UnknownKeys};
use super::write::ObjectWriter;
use crate::buffer::{EncodeError, PacketBuffer};
use crate::message::{Bumpers, Cliffs, Event, Inhibits, Motor, MoveEnd, NumberedEvent, Refusal, WheelDrops};
use crate::span;

/// Direction of a bump for tools of 2016, in degrees: left positive.
const BUMP_ANGLE_DEG: i64 = 45;
/// Length of the members after the names of inhibits: number and tick.
const TAIL_BYTES: usize = 24;

const fn word(kind: &Event) -> &'static str {
    match kind {
        Event::Bump(_) => "bump",
        Event::Cliff(_) => "cliff",
        Event::Lift(_) => "lift",
        Event::Button { .. } => "button",
        Event::Docked(_) => "docked",
        Event::MoveFinished(_) => "move-finished",
        Event::Inhibits(_) => "inhibits",
        Event::Stall(_) => "stall",
    }
}

const fn end_name(end: MoveEnd) -> &'static str {
    match end {
        MoveEnd::Done => "done",
        MoveEnd::Inhibited => "inhibited",
        MoveEnd::Replaced => "replaced",
        MoveEnd::TimedOut => "timed-out",
    }
}

pub(super) fn write(event: &NumberedEvent, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
    let mut object = ObjectWriter::new(buffer);
    object.name("e", word(&event.kind));
    write_members(&event.kind, &mut object);
    object
        .number("n", event.number, span::WORD)
        .number("t", event.tick.0, span::TOTAL)
        .finish()
}

fn write_members(kind: &Event, object: &mut ObjectWriter<'_>) {
    match kind {
        Event::Bump(bumpers) => {
            let angle = BUMP_ANGLE_DEG * (i64::from(bumpers.left) - i64::from(bumpers.right));
            object
                .number("angle", angle, span::COUNT)
                .flag("left", bumpers.left)
                .flag("right", bumpers.right)
        }
        Event::Cliff(cliffs) => object
            .flag("left", cliffs.left)
            .flag("middle", cliffs.middle)
            .flag("right", cliffs.right),
        Event::Lift(drops) => object.flag("left", drops.left).flag("right", drops.right),
        Event::Button { button, pressed } => object
            .number("button", *button, span::BYTE)
            .flag("pressed", *pressed),
        Event::Docked(docked) => object.flag("on", *docked),
        Event::MoveFinished(end) => object.name("end", end_name(*end)),
        Event::Inhibits(inhibits) => object
            .number("bits", inhibits.bits(), span::TOTAL)
            .names_that_fit(
                "names",
                inhibits.iter().map(crate::message::Inhibit::name),
                TAIL_BYTES,
            ),
        Event::Stall(motor) => object.name("motor", motor.name()),
    };
}

/// Reads an event whose `e` is `word`.
pub(super) fn read(text: &[u8], word: &[u8]) -> Result<NumberedEvent, Refusal> {
    let fields = Fields::read(text, ["e", "n", "t"], UnknownKeys::Ignore)?;
    Ok(NumberedEvent {
        number: fields.word(1, span::WORD)?,
        tick: Tick(fields.total(2)?),
        kind: read_kind(text, word)?,
    })
}

fn read_kind(text: &[u8], word: &[u8]) -> Result<Event, Refusal> {
    match word {
        b"bump" => {
            read_flags(text, ["left", "right"]).map(|[left, right]| Event::Bump(Bumpers { left, right }))
        }
        b"cliff" => read_flags(text, ["left", "middle", "right"])
            .map(|[left, middle, right]| Event::Cliff(Cliffs { left, middle, right })),
        b"lift" => {
            read_flags(text, ["left", "right"]).map(|[left, right]| Event::Lift(WheelDrops { left, right }))
        }
        b"button" => {
            let fields = Fields::read(text, ["button", "pressed"], UnknownKeys::Ignore)?;
            Ok(Event::Button {
                button: fields.byte(0)?,
                pressed: fields.flag(1)?,
            })
        }
        b"docked" => read_flags(text, ["on"]).map(|[docked]| Event::Docked(docked)),
        b"move-finished" => read_end(text).map(Event::MoveFinished),
        b"inhibits" => {
            let fields = Fields::read(text, ["bits"], UnknownKeys::Ignore)?;
            Ok(Event::Inhibits(Inhibits::from_bits(fields.total(0)?)))
        }
        b"stall" => {
            let fields = Fields::read(text, ["motor"], UnknownKeys::Ignore)?;
            Motor::from_name(fields.text(0)?)
                .map(Event::Stall)
                .ok_or(Refusal::Unknown)
        }
        _ => Err(Refusal::Unknown),
    }
}

fn read_flags<const N: usize>(text: &[u8], keys: [&str; N]) -> Result<[bool; N], Refusal> {
    let fields = Fields::read(text, keys, UnknownKeys::Ignore)?;
    let mut flags = [false; N];
    for (index, flag) in flags.iter_mut().enumerate() {
        *flag = fields.flag(index)?;
    }
    Ok(flags)
}

fn read_end(text: &[u8]) -> Result<MoveEnd, Refusal> {
    let fields = Fields::read(text, ["end"], UnknownKeys::Ignore)?;
    let name = fields.text(0)?;
    [
        MoveEnd::Done,
        MoveEnd::Inhibited,
        MoveEnd::Replaced,
        MoveEnd::TimedOut,
    ]
    .into_iter()
    .find(|end| end_name(*end).as_bytes() == name)
    .ok_or(Refusal::Unknown)
}
