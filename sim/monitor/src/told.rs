//! What a robot tells about itself: the reports whose values somebody outside can check.

use serde_json::Value;

use super::wire::{CrcCheck, WireDirection, checked_binary, split_crc};

/// A report of the robot that tells a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Told {
    /// `describe`, the row of the parts.
    Parts(Declared),
    /// `state`.
    State(ToldState),
    /// `info`, its packet of the battery.
    Pack(ToldPack),
}

/// Parts that the robot says it has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Declared {
    pub(crate) bumpers: u64,
    pub(crate) cliffs: u64,
    pub(crate) wheel_drops: u64,
    pub(crate) proximity: u64,
    pub(crate) dock_receivers: u64,
    pub(crate) buttons: u64,
    pub(crate) encoders: bool,
    pub(crate) gyro: bool,
    pub(crate) currents: bool,
    pub(crate) battery: bool,
}

/// Telemetry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ToldState {
    pub(crate) counts: [i32; 2],
    pub(crate) bumpers: [bool; 2],
    pub(crate) cliffs: [bool; 3],
    pub(crate) wheel_drops: [bool; 2],
    /// Of the wheels; `None` = it says that it does not measure them now.
    pub(crate) currents_ma: Option<[i32; 2]>,
    pub(crate) has_gyro: bool,
    /// Closeness at each proximity sensor.
    pub(crate) near: [u8; 8],
    /// A dock receiver shows something.
    pub(crate) has_beams: bool,
    pub(crate) buttons: u8,
}

/// The battery.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ToldPack {
    pub(crate) pack_mv: i32,
    /// Tenths of a degree; `None` = it is not told.
    pub(crate) temperature_dc: Option<i32>,
}

/// Reads a packet of the robot; `None` when it tells nothing that is checked.
pub(crate) fn read_told(packet: &[u8], session: u16) -> Option<Told> {
    if packet[0] >= 0x80 {
        return read_binary(&checked_binary(packet, WireDirection::FromRobot, session)?);
    }
    let (json, crc) = split_crc(packet, WireDirection::FromRobot, session);
    if crc != CrcCheck::Right {
        return None;
    }
    if json.starts_with(br#"{"c":"state""#) {
        let object: Value = serde_json::from_slice(json).ok()?;
        Some(Told::State(state_of(&object)))
    } else if json.starts_with(br#"{"c":"info","battery"#) {
        let object: Value = serde_json::from_slice(json).ok()?;
        pack_of(&object).map(Told::Pack)
    } else if json.starts_with(br#"{"c":"describe""#) {
        let object: Value = serde_json::from_slice(json).ok()?;
        (object["of"] == "parts").then(|| Told::Parts(parts_of(&object)))
    } else {
        None
    }
}

fn state_of(object: &Value) -> ToldState {
    let flags = object["f"].as_str().unwrap_or_default();
    let flag = |letter: char| flags.contains(letter);
    let count = |key: &str| object[key].as_i64().unwrap_or(0) as i32;
    let milliamperes = |key: &str| (object[key].as_f64().unwrap_or(0.0) * 1e3).round() as i32;
    let shows = |key: &str| {
        object[key]
            .as_str()
            .is_some_and(|digits| digits.bytes().any(|digit| digit != b'0'))
    };
    ToldState {
        counts: [count("l"), count("r")],
        bumpers: [flag('b'), flag('B')],
        cliffs: [flag('c'), flag('m'), flag('C')],
        wheel_drops: [flag('w'), flag('W')],
        currents_ma: (!flag('n')).then(|| [milliamperes("x"), milliamperes("y")]),
        has_gyro: !object["h"].is_null() || !object["g"].is_null(),
        near: bytes_of(object["p"].as_str().unwrap_or_default()),
        has_beams: shows("d"),
        buttons: object["k"].as_u64().unwrap_or(0) as u8,
    }
}

/// Kind 0x82 is `state`, its numbers little endian.
fn read_binary(body: &[u8]) -> Option<Told> {
    let [0x82, body @ ..] = body else { return None };
    let body: &[u8; 50] = body.try_into().ok()?;
    let long = |at: usize| i32::from_le_bytes([body[at], body[at + 1], body[at + 2], body[at + 3]]);
    let short = |at: usize| i32::from(i16::from_le_bytes([body[at], body[at + 1]]));
    let flags = u16::from_le_bytes([body[32], body[33]]);
    let flag = |bit: u16| flags >> bit & 1 == 1;
    Some(Told::State(ToldState {
        counts: [long(4), long(8)],
        bumpers: [flag(0), flag(1)],
        cliffs: [flag(2), flag(3), flag(4)],
        wheel_drops: [flag(5), flag(6)],
        currents_ma: (!flag(14)).then(|| [short(36), short(38)]),
        has_gyro: flag(12),
        near: [20, 21, 22, 23, 24, 25, 26, 27].map(|at: usize| body[at]),
        buttons: body[34],
        has_beams: body[28..32].iter().any(|byte| *byte != 0),
    }))
}

/// Two hexadecimal digits each; what is missing or none is 0.
fn bytes_of(digits: &str) -> [u8; 8] {
    let mut bytes = [0; 8];
    for (byte, pair) in bytes.iter_mut().zip(digits.as_bytes().chunks(2)) {
        *byte = core::str::from_utf8(pair)
            .ok()
            .and_then(|pair| u8::from_str_radix(pair, 16).ok())
            .unwrap_or(0);
    }
    bytes
}

fn pack_of(object: &Value) -> Option<ToldPack> {
    Some(ToldPack {
        pack_mv: (object["battery-voltage"].as_f64()? * 1e3).round() as i32,
        temperature_dc: object["battery-temperature"]
            .as_f64()
            .map(|celsius| (celsius * 10.0).round() as i32),
    })
}

fn parts_of(object: &Value) -> Declared {
    let number = |key: &str| object[key].as_u64().unwrap_or(0);
    let list = object["has"].as_str().unwrap_or_default();
    let has = |name: &str| list.split(' ').any(|known| known == name);
    Declared {
        bumpers: number("bumpers"),
        cliffs: number("cliffs"),
        wheel_drops: number("wheel-drops"),
        proximity: number("proximity"),
        dock_receivers: number("dock-receivers"),
        buttons: number("buttons"),
        encoders: has("encoders"),
        gyro: has("gyro"),
        currents: has("currents"),
        battery: has("battery"),
    }
}
