//! Commands from text.

use rvac_units::{AngularSpeed, Frequency, Length, Ratio, Speed, Throttle, Tick};

use super::fields::{Fields, UnknownKeys, lists};
use super::scan::{Members, Value};
use crate::message::{
    Beep, BinaryKinds, Command, CommandName, Drive, HostHello, Inhibit, Led, LedPattern, Motor, MotorCommand,
    Move, PROBE_LEASE_MS_MAX, Parameter, Probe, ProbeTarget, ProtocolVersion, Refusal, Sequence,
};
use crate::span;

/// How strict a packet must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Checked mode: every key of a motion command is required, and the number of every command that has one.
    Checked,
    /// Hand mode, without a CRC: `ttl` (250), `n` (0), `t` (the present tick), `radius` (straight) may be absent.
    Hand {
        /// The present tick.
        now: Tick,
    },
    /// Hand mode, with the right CRC: a program wrote it.
    SealedHand {
        /// The present tick.
        now: Tick,
    },
}

impl Form {
    /// What an unknown key of a motion command means: without a CRC a person's typing error, which must not move anything,
    /// and with one the word of a newer peer. The one place that decides.
    const fn unknown_keys(self) -> UnknownKeys {
        match self {
            Self::Checked | Self::SealedHand { .. } => UnknownKeys::Ignore,
            Self::Hand { .. } => UnknownKeys::Refuse,
        }
    }

    /// The tick that stands in for keys that may be absent; `None` where none may be.
    const fn hand_tick(self) -> Option<Tick> {
        match self {
            Self::Checked => None,
            Self::Hand { now } | Self::SealedHand { now } => Some(now),
        }
    }
}

/// A command that was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RefusedCommand {
    /// Its number, if one could be read.
    pub sequence: Option<Sequence>,
    /// Why.
    pub refusal: Refusal,
}

const LEASE_DEFAULT_MS: u16 = 250;

type Read = Result<Command, Refusal>;

/// Reads a command.
///
/// # Errors
/// Why it is refused, and the number for the answer.
pub fn read_command(text: &[u8], form: Form) -> Result<Command, RefusedCommand> {
    read(text, form).map_err(|refusal| RefusedCommand {
        sequence: sequence_of(text),
        refusal,
    })
}

/// Whether the text is a `stop`, which is obeyed even in a damaged packet: the bare word, or any text that begins like
/// an object whose `c` is `stop`.
#[must_use]
pub fn is_stop(text: &[u8]) -> bool {
    text == b"stop" || word_of(text) == Ok(b"stop")
}

fn read(text: &[u8], form: Form) -> Read {
    let name = CommandName::from_name(word_of(text)?).ok_or(Refusal::Unknown)?;
    match name {
        CommandName::Hello => read_hello(text),
        CommandName::Hand => bare(text, Command::Hand),
        CommandName::Describe => read_describe(text),
        CommandName::Info => bare(text, Command::Info),
        CommandName::State => bare(text, Command::State),
        CommandName::Drive => read_drive(text, form),
        CommandName::Motor => read_motor(text, form),
        CommandName::Move => read_move(text, form),
        CommandName::Stop => bare(text, Command::Stop),
        CommandName::Beep => read_beep(text),
        CommandName::Led => read_led(text),
        CommandName::Arm => read_arm(text, form),
        CommandName::Clear => read_clear(text, form),
        CommandName::Set => read_set(text, form),
        CommandName::Ping => read_ping(text, form),
        CommandName::Seen => read_seen(text),
        CommandName::Charge => read_charge(text, form),
        CommandName::Probe => read_probe(text, form),
    }
}

/// The value of `c`. It usually is the first member, so this rarely reads far.
fn word_of(text: &[u8]) -> Result<&[u8], Refusal> {
    let mut members = Members::of(text)?;
    while let Some((key, value)) = members.next()? {
        if key == b"c" {
            return value.text();
        }
    }
    Err(Refusal::Missing)
}

fn sequence_of(text: &[u8]) -> Option<Sequence> {
    let mut members = Members::of(text).ok()?;
    while let Ok(Some((key, value))) = members.next() {
        if key == b"n" {
            return value
                .number(span::WORD)
                .ok()
                .and_then(|number| u16::try_from(number).ok())
                .map(Sequence);
        }
    }
    None
}

fn bare(text: &[u8], command: Command) -> Read {
    Fields::read(text, ["c"], UnknownKeys::Ignore).map(|_| command)
}

fn read_hello(text: &[u8]) -> Read {
    let fields = Fields::read(text, ["c", "min", "max", "bin"], UnknownKeys::Ignore)?;
    let binary = fields.text_or_empty(3)?;
    Ok(Command::Hello(HostHello {
        version_min: ProtocolVersion(fields.byte(1)?),
        version_max: ProtocolVersion(fields.byte(2)?),
        binary: binary_kinds(binary),
    }))
}

/// Kinds by name; kinds of a newer peer are ignored.
pub(super) fn binary_kinds(words: &[u8]) -> BinaryKinds {
    BinaryKinds {
        state: lists(words, "state"),
        drive: lists(words, "drive"),
    }
}

fn read_describe(text: &[u8]) -> Read {
    let fields = Fields::read(text, ["c", "row"], UnknownKeys::Ignore)?;
    Ok(Command::Describe { row: fields.byte(1)? })
}

/// Lease, number and tick of a motion command at `ttl`, `n` and `t`.
struct Freshness {
    lease_ms: u16,
    sequence: Sequence,
    seen_tick: Tick,
}

impl Freshness {
    fn read<const N: usize>(fields: &Fields<'_, N>, at: [usize; 3], form: Form) -> Result<Self, Refusal> {
        let [ttl, n, t] = at;
        let lease_ms = match form.hand_tick() {
            Some(_) if !fields.has(ttl) => LEASE_DEFAULT_MS,
            _ => fields.word(ttl, span::LEASE)?,
        };
        Ok(Self {
            lease_ms,
            sequence: read_sequence(fields, n, form)?,
            seen_tick: read_tick(fields, t, form)?,
        })
    }
}

fn read_sequence<const N: usize>(fields: &Fields<'_, N>, n: usize, form: Form) -> Result<Sequence, Refusal> {
    match form.hand_tick() {
        Some(_) if !fields.has(n) => Ok(Sequence(0)),
        _ => fields.word(n, span::WORD).map(Sequence),
    }
}

fn read_tick<const N: usize>(fields: &Fields<'_, N>, t: usize, form: Form) -> Result<Tick, Refusal> {
    match form.hand_tick() {
        Some(now) if !fields.has(t) => Ok(now),
        _ => fields.total(t).map(Tick),
    }
}

fn read_drive(text: &[u8], form: Form) -> Read {
    let fields = Fields::read(text, ["c", "v", "w", "ttl", "n", "t"], form.unknown_keys())?;
    let freshness = Freshness::read(&fields, [3, 4, 5], form)?;
    Ok(Command::Drive(Drive {
        speed: Speed(fields.int(1, span::SPEED)?),
        turn: AngularSpeed(fields.int(2, span::TURN)?),
        lease_ms: freshness.lease_ms,
        sequence: freshness.sequence,
        seen_tick: freshness.seen_tick,
    }))
}

fn read_motor(text: &[u8], form: Form) -> Read {
    let fields = Fields::read(
        text,
        ["c", "motor", "throttle", "ttl", "n", "t"],
        form.unknown_keys(),
    )?;
    let throttle = fields.int(2, span::THROTTLE)?;
    let freshness = Freshness::read(&fields, [3, 4, 5], form)?;
    Ok(Command::Motor(MotorCommand {
        motor: Motor::from_name(fields.text(1)?).ok_or(Refusal::Unknown)?,
        throttle: Throttle::from_millionths(throttle).map_err(|_| Refusal::Range)?,
        lease_ms: freshness.lease_ms,
        sequence: freshness.sequence,
        seen_tick: freshness.seen_tick,
    }))
}

fn read_move(text: &[u8], form: Form) -> Read {
    let fields = Fields::read(text, ["c", "length", "radius", "n", "t"], form.unknown_keys())?;
    let radius = match (fields.get(2), form.hand_tick()) {
        (Some(Value::Null), _) | (None, Some(_)) => None,
        _ => Some(Length(fields.int(2, span::MOVE_RADIUS)?)),
    };
    Ok(Command::Move(Move {
        length: Length(fields.int(1, span::MOVE_LENGTH)?),
        radius,
        sequence: read_sequence(&fields, 3, form)?,
        seen_tick: read_tick(&fields, 4, form)?,
    }))
}

fn read_beep(text: &[u8]) -> Read {
    let fields = Fields::read(text, ["c", "pitch", "duration", "volume"], UnknownKeys::Ignore)?;
    let pitch = fields.int(1, span::PITCH)?;
    if !span::is_pitch(i64::from(pitch)) {
        return Err(Refusal::Range);
    }
    Ok(Command::Beep(Beep {
        pitch: Frequency(pitch),
        duration_ms: fields.word(2, span::DURATION)?,
        volume: read_ratio(&fields, 3)?,
    }))
}

fn read_led(text: &[u8]) -> Read {
    let fields = Fields::read(text, ["c", "led", "pattern", "brightness"], UnknownKeys::Ignore)?;
    Ok(Command::Led(Led {
        led: u8::try_from(fields.number(1, span::LED)?).map_err(|_| Refusal::Range)?,
        pattern: LedPattern::from_name(fields.text(2)?).ok_or(Refusal::Unknown)?,
        brightness: read_ratio(&fields, 3)?,
    }))
}

/// A ratio that is 1 when absent.
fn read_ratio<const N: usize>(fields: &Fields<'_, N>, index: usize) -> Result<Ratio, Refusal> {
    if fields.has(index) {
        Ratio::from_millionths(fields.int(index, span::RATIO)?).map_err(|_| Refusal::Range)
    } else {
        Ok(Ratio::ONE)
    }
}

fn read_arm(text: &[u8], form: Form) -> Read {
    let fields = Fields::read(text, ["c", "undock", "n"], UnknownKeys::Ignore)?;
    Ok(Command::Arm {
        undock: if fields.has(1) { fields.flag(1)? } else { false },
        sequence: read_sequence(&fields, 2, form)?,
    })
}

fn read_clear(text: &[u8], form: Form) -> Read {
    let fields = Fields::read(text, ["c", "inhibit", "n"], UnknownKeys::Ignore)?;
    Ok(Command::Clear {
        inhibit: Inhibit::from_name(fields.text(1)?).ok_or(Refusal::Unknown)?,
        sequence: read_sequence(&fields, 2, form)?,
    })
}

fn read_set(text: &[u8], form: Form) -> Read {
    let fields = Fields::read(text, ["c", "name", "value", "n"], UnknownKeys::Ignore)?;
    let parameter = Parameter::from_name(fields.text(1)?).ok_or(Refusal::Unknown)?;
    let value = fields.int(2, span::COUNT)?;
    let (min, max) = parameter.range();
    if value != 0 && !(min..=max).contains(&value) {
        return Err(Refusal::Range);
    }
    Ok(Command::Set {
        parameter,
        value,
        sequence: read_sequence(&fields, 3, form)?,
    })
}

fn read_ping(text: &[u8], form: Form) -> Read {
    let fields = Fields::read(text, ["c", "n"], UnknownKeys::Ignore)?;
    Ok(Command::Ping {
        sequence: read_sequence(&fields, 1, form)?,
    })
}

fn read_seen(text: &[u8]) -> Read {
    let fields = Fields::read(text, ["c", "n"], UnknownKeys::Ignore)?;
    Ok(Command::Seen {
        event: fields.word(1, span::WORD)?,
    })
}

fn read_charge(text: &[u8], form: Form) -> Read {
    let fields = Fields::read(text, ["c", "on", "n"], UnknownKeys::Ignore)?;
    Ok(Command::Charge {
        wanted: fields.flag(1)?,
        sequence: read_sequence(&fields, 2, form)?,
    })
}

fn read_probe(text: &[u8], form: Form) -> Read {
    let fields = Fields::read(text, ["c", "of", "port", "baud", "ttl", "n"], UnknownKeys::Ignore)?;
    let target = match fields.text(1)? {
        b"analog" => ProbeTarget::Analog,
        b"encoders" => ProbeTarget::Encoders,
        b"lines" => ProbeTarget::Lines,
        b"buttons" => ProbeTarget::Buttons,
        b"serial" => ProbeTarget::Serial {
            port: fields.byte(2)?,
            baud: u32::try_from(fields.number(3, span::BAUD)?).map_err(|_| Refusal::Range)?,
        },
        _ => return Err(Refusal::Unknown),
    };
    let is_serial = matches!(target, ProbeTarget::Serial { .. });
    let lease_ms = match (fields.has(4), is_serial) {
        (true, _) => fields.word(4, span::PROBE_LEASE)?,
        (false, true) => PROBE_LEASE_MS_MAX,
        (false, false) => 0,
    };
    // Bytes arrive over time: a serial port has no single answer.
    if is_serial && lease_ms == 0 {
        return Err(Refusal::Range);
    }
    Ok(Command::Probe(Probe {
        target,
        lease_ms,
        sequence: read_sequence(&fields, 5, form)?,
    }))
}
