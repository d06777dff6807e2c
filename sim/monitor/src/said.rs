//! The few messages of both directions that decide whether motors may run.

use serde_json::Value;

use super::wire::{CrcCheck, WireDirection, checked_binary, split_crc};

/// A packet to the robot whose CRC is right or absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeardPacket {
    pub(crate) word: Heard,
    pub(crate) checked: bool,
}

/// A message to the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Heard {
    Stop,
    Hand,
    Arm {
        number: Option<u16>,
        undock: bool,
    },
    /// Of any latch: the firmware may still refuse it.
    Clear,
    /// Something that may turn these wheels, left and right, for `lease_ms`.
    Wheels {
        wheels: [bool; 2],
        lease_ms: u64,
        mark: Mark,
        /// The fastest rim that it asks for; `None` = it asks for no speed.
        rim_mm_per_s: Option<i32>,
    },
    /// Something that may turn main brush (0), side brushes (1) or suction (2) for `lease_ms`.
    Cleaner {
        cleaner: usize,
        lease_ms: u64,
        mark: Mark,
    },
    Other,
}

impl Heard {
    /// Whether it arms or moves.
    pub(crate) const fn moves(self) -> bool {
        matches!(
            self,
            Self::Arm { .. } | Self::Wheels { .. } | Self::Cleaner { .. }
        )
    }
}

/// Number and tick of a motion command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mark {
    pub(crate) number: Option<u16>,
    pub(crate) tick: Option<u32>,
}

/// A message of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Said {
    /// The session number from now on.
    Session(u16),
    /// The command with this number was refused.
    Refused(u16),
}

/// A `move` has no lease; it may take as long as its path takes at the lowest speed, plus some seconds.
const MOVE_SLOWEST_M_PER_S: f64 = 0.02;
const MOVE_EXTRA_MS: u64 = 5_000;
const LEASE_DEFAULT_MS: u64 = 250;
const LEASE_MAX_MS: u64 = 1_000;

/// Reads a packet to the robot; `None` when its CRC is wrong or it is no packet at all.
pub(crate) fn read_heard(packet: &[u8], session: u16) -> Option<HeardPacket> {
    if packet[0] >= 0x80 {
        let body = checked_binary(packet, WireDirection::ToRobot, session)?;
        return Some(HeardPacket {
            word: word_of_binary(&body),
            checked: true,
        });
    }
    let (json, crc) = split_crc(packet, WireDirection::ToRobot, session);
    if crc == CrcCheck::Wrong {
        return None;
    }
    let object: Value = serde_json::from_slice(json).ok()?;
    Some(HeardPacket {
        word: word_of(&object),
        checked: crc == CrcCheck::Right,
    })
}

fn word_of(object: &Value) -> Heard {
    match object["c"].as_str() {
        Some("stop") => Heard::Stop,
        Some("hand") => Heard::Hand,
        Some("clear") => Heard::Clear,
        Some("arm") => Heard::Arm {
            number: number_of(object, "n"),
            undock: object["undock"].as_bool() == Some(true) || object["undock"].as_u64() == Some(1),
        },
        Some("drive") => Heard::Wheels {
            wheels: [true; 2],
            lease_ms: lease_of(object),
            mark: mark_of(object),
            rim_mm_per_s: object["v"]
                .as_f64()
                .zip(object["w"].as_f64())
                .map(|(speed, turn)| rim_of(speed, turn)),
        },
        Some("motor") => word_of_motor(object),
        Some("move") => Heard::Wheels {
            wheels: [true; 2],
            lease_ms: move_ms(object["length"].as_f64().unwrap_or(0.0)),
            mark: mark_of(object),
            rim_mm_per_s: None,
        },
        _ => Heard::Other,
    }
}

fn word_of_motor(object: &Value) -> Heard {
    let (lease_ms, mark) = (lease_of(object), mark_of(object));
    let cleaner = |cleaner| Heard::Cleaner {
        cleaner,
        lease_ms,
        mark,
    };
    let wheels = |wheels| Heard::Wheels {
        wheels,
        lease_ms,
        mark,
        rim_mm_per_s: None,
    };
    match object["motor"].as_str() {
        Some("wheel left") => wheels([true, false]),
        Some("wheel right") => wheels([false, true]),
        Some("brush main") => cleaner(0),
        Some("brush sides") => cleaner(1),
        Some("vacuum") => cleaner(2),
        _ => Heard::Other,
    }
}

/// Kind 0x81 is `drive`: speed and turn rate, then lease, number and tick, all little endian.
fn word_of_binary(body: &[u8]) -> Heard {
    match body {
        [
            0x81,
            v0,
            v1,
            v2,
            v3,
            w0,
            w1,
            w2,
            w3,
            l0,
            l1,
            n0,
            n1,
            t0,
            t1,
            t2,
            t3,
        ] => Heard::Wheels {
            wheels: [true; 2],
            rim_mm_per_s: Some(rim_of(
                f64::from(i32::from_le_bytes([*v0, *v1, *v2, *v3])) / 1e6,
                f64::from(i32::from_le_bytes([*w0, *w1, *w2, *w3])) / 1e6,
            )),
            lease_ms: u64::from(u16::from_le_bytes([*l0, *l1])).min(LEASE_MAX_MS),
            mark: Mark {
                number: Some(u16::from_le_bytes([*n0, *n1])),
                tick: Some(u32::from_le_bytes([*t0, *t1, *t2, *t3])),
            },
        },
        _ => Heard::Other,
    }
}

/// No robot that fits beneath furniture has its wheels farther from its middle.
const HALF_TRACK_MOST_M: f64 = 0.15;

fn rim_of(speed_m_per_s: f64, turn_rad_per_s: f64) -> i32 {
    ((speed_m_per_s.abs() + turn_rad_per_s.abs() * HALF_TRACK_MOST_M) * 1e3) as i32
}

fn move_ms(length_m: f64) -> u64 {
    (length_m.abs() / MOVE_SLOWEST_M_PER_S * 1000.0) as u64 + MOVE_EXTRA_MS
}

fn lease_of(object: &Value) -> u64 {
    object["ttl"]
        .as_u64()
        .unwrap_or(LEASE_DEFAULT_MS)
        .min(LEASE_MAX_MS)
}

fn mark_of(object: &Value) -> Mark {
    Mark {
        number: number_of(object, "n"),
        tick: object["t"].as_u64().and_then(|tick| tick.try_into().ok()),
    }
}

fn number_of(object: &Value, key: &str) -> Option<u16> {
    object[key].as_u64().and_then(|number| number.try_into().ok())
}

/// Reads a packet of the robot, if it is relevant.
pub(crate) fn read_said(packet: &[u8], session: u16) -> Option<Said> {
    let hello = packet.starts_with(br#"{"c":"hello""#);
    if !hello && !packet.starts_with(br#"{"a":"#) {
        return None;
    }
    // The hello that opens a session may have the CRC of the old session or of the one that it opens.
    let (json, _) = split_crc(packet, WireDirection::FromRobot, session);
    let object: Value = serde_json::from_slice(json).ok()?;
    if hello {
        return number_of(&object, "session").map(Said::Session);
    }
    object["err"]
        .as_str()
        .and(number_of(&object, "a"))
        .map(Said::Refused)
}
