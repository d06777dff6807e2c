//! Telemetry as text. Keys are single letters, so that the longest report with its CRC fits one packet.

use rvac_units::{Angle, AngularSpeed, Current, Tick, Voltage};

use super::fields::{Fields, UnknownKeys};
use super::write::ObjectWriter;
use crate::buffer::EncodeError;
use crate::message::{
    Bumpers, ChargeState, Cliffs, Currents, Gyro, Inhibits, MotionPhase, PackReading, Refusal, State,
    WheelDrops,
};
use crate::span;

const KEYS: [&str; 17] = [
    "c", "t", "l", "r", "h", "g", "p", "d", "f", "k", "x", "y", "z", "v", "a", "s", "i",
];

/// The letter of the charger's state.
const fn charge_letter(charge: ChargeState) -> u8 {
    match charge {
        ChargeState::Discharging => b'd',
        ChargeState::Charging => b'c',
        ChargeState::Full => b'f',
        ChargeState::Fault => b'x',
    }
}

/// The letter of the motion phase.
const fn motion_letter(motion: MotionPhase) -> u8 {
    match motion {
        MotionPhase::Idle => b'i',
        MotionPhase::Drive => b'd',
        MotionPhase::Move => b'm',
        MotionPhase::Motor => b'w',
        MotionPhase::Reflex => b'r',
    }
}

/// Flags by letter: lower case is left, upper case is right.
fn flags(state: &State) -> heapless::String<15> {
    let cleaner = |bit: u8| state.cleaners >> bit & 1 == 1;
    let letters = [
        ('b', state.bumpers.left),
        ('B', state.bumpers.right),
        ('c', state.cliffs.left),
        ('m', state.cliffs.middle),
        ('C', state.cliffs.right),
        ('w', state.wheel_drops.left),
        ('W', state.wheel_drops.right),
        ('x', state.dust_box == Some(true)),
        ('d', state.docked),
        ('h', cleaner(0)),
        ('s', cleaner(1)),
        ('v', cleaner(2)),
        ('X', state.dust_box.is_none()),
        ('n', state.currents.is_none()),
        ('a', state.pack.is_none()),
    ];
    let mut flags = heapless::String::new();
    for (letter, set) in letters {
        if set {
            // Fifteen letters fit fifteen places.
            flags.push(letter).ok();
        }
    }
    flags
}

pub(super) fn write(state: &State, object: &mut ObjectWriter<'_>) -> Result<(), EncodeError> {
    let currents = state.currents.unwrap_or_default();
    let pack = state.pack.unwrap_or_default();
    object
        .name("c", "state")
        .number("t", state.tick.0, span::TOTAL)
        .number("l", state.count_left, span::COUNT)
        .number("r", state.count_right, span::COUNT);
    if let Some(gyro) = state.gyro {
        object
            .number("h", gyro.heading.0, span::MICRO)
            .number("g", gyro.rate.0, span::MICRO);
    }
    object
        .hex("p", &state.proximity)
        .hex("d", &state.dock)
        .name("f", &flags(state))
        .number("k", state.buttons, span::BYTE)
        .measured("x", currents.wheel_left.0, span::CURRENT)
        .measured("y", currents.wheel_right.0, span::CURRENT)
        .measured("z", currents.brush_main.0, span::CURRENT)
        .measured("v", pack.voltage.0, span::VOLTAGE)
        .measured("a", pack.current.0, span::CURRENT)
        .letters("s", [charge_letter(state.charge), motion_letter(state.motion)])
        .number("i", state.inhibits.bits(), span::TOTAL)
        .finish()
}

pub(super) fn read(text: &[u8]) -> Result<State, Refusal> {
    let fields = Fields::read(text, KEYS, UnknownKeys::Ignore)?;
    let [charge, motion] = *fields.text(15)? else {
        return Err(Refusal::Unknown);
    };
    let flags = fields.text(8)?;
    let flag = |letter: u8| flags.contains(&letter);
    let cleaners = u8::from(flag(b'h')) | u8::from(flag(b's')) << 1 | u8::from(flag(b'v')) << 2;
    let current = |index| fields.int(index, span::CURRENT).map(Current);
    let currents = Currents {
        wheel_left: current(10)?,
        wheel_right: current(11)?,
        brush_main: current(12)?,
    };
    let pack = PackReading {
        voltage: Voltage(fields.int(13, span::VOLTAGE)?),
        current: current(14)?,
    };
    Ok(State {
        tick: Tick(fields.total(1)?),
        count_left: fields.int(2, span::COUNT)?,
        count_right: fields.int(3, span::COUNT)?,
        gyro: read_gyro(&fields)?,
        bumpers: Bumpers {
            left: flag(b'b'),
            right: flag(b'B'),
        },
        cliffs: Cliffs {
            left: flag(b'c'),
            middle: flag(b'm'),
            right: flag(b'C'),
        },
        wheel_drops: WheelDrops {
            left: flag(b'w'),
            right: flag(b'W'),
        },
        proximity: read_hex(fields.text(6)?)?,
        dock: read_hex(fields.text(7)?)?,
        buttons: fields.byte(9)?,
        dust_box: (!flag(b'X')).then_some(flag(b'x')),
        currents: (!flag(b'n')).then_some(currents),
        pack: (!flag(b'a')).then_some(pack),
        charge: charge_from_letter(charge)?,
        docked: flag(b'd'),
        inhibits: Inhibits::from_bits(fields.total(16)?),
        motion: motion_from_letter(motion)?,
        cleaners,
    })
}

fn read_gyro(fields: &Fields<'_, 17>) -> Result<Option<Gyro>, Refusal> {
    if !fields.has(4) && !fields.has(5) {
        return Ok(None);
    }
    Ok(Some(Gyro {
        heading: Angle(fields.int(4, span::MICRO)?),
        rate: AngularSpeed(fields.int(5, span::MICRO)?),
    }))
}

fn charge_from_letter(letter: u8) -> Result<ChargeState, Refusal> {
    [
        ChargeState::Discharging,
        ChargeState::Charging,
        ChargeState::Full,
        ChargeState::Fault,
    ]
    .into_iter()
    .find(|charge| charge_letter(*charge) == letter)
    .ok_or(Refusal::Unknown)
}

fn motion_from_letter(letter: u8) -> Result<MotionPhase, Refusal> {
    [
        MotionPhase::Idle,
        MotionPhase::Drive,
        MotionPhase::Move,
        MotionPhase::Motor,
        MotionPhase::Reflex,
    ]
    .into_iter()
    .find(|motion| motion_letter(*motion) == letter)
    .ok_or(Refusal::Unknown)
}

/// `N` bytes as `2 N` hexadecimal digits of either case.
fn read_hex<const N: usize>(digits: &[u8]) -> Result<[u8; N], Refusal> {
    let (pairs, rest) = digits.as_chunks::<2>();
    if pairs.len() != N || !rest.is_empty() {
        return Err(Refusal::Range);
    }
    let mut bytes = [0; N];
    for (byte, [high, low]) in bytes.iter_mut().zip(pairs) {
        let digit = |digit: u8| (digit as char).to_digit(16).ok_or(Refusal::Syntax);
        *byte = (digit(*high)? << 4 | digit(*low)?) as u8;
    }
    Ok(bytes)
}
